#include "hextwist/sizing/sizes_met.h"

#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {

std::optional<SizeReport> sizes_met(const MeshedModel& input, const Request& request,
                                    std::vector<std::string>& notices) {
  const Sizes* sizes = std::get_if<Sizes>(&request.how);
  if (!sizes || sizes->coarsen || request.finish.level_field) return std::nullopt;
  const SizeWish wish(input, request);
  std::vector<std::string> told;
  std::vector<Index> target = region_target(input, request.target, told);
  std::vector<std::uint8_t> in_zone(input.mesh.hexes.size(), wish.is_everywhere());
  for (const Index h : target) in_zone[h] = 1;
  if (!wish.too_large(input.mesh, in_zone).empty() || !wish.nodes_too_far_apart(input.mesh, in_zone).empty())
    return std::nullopt;
  notices.insert(notices.end(), told.begin(), told.end());
  return size_report(input.mesh, std::move(target), wish.field());
}

}  // namespace hextwist
