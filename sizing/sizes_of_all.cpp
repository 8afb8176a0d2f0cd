#include "hextwist/sizing/sizes_of_all.h"

#include <algorithm>

#include "hextwist/base/sorted.h"
#include "hextwist/sizing/size_report.h"
#include "hextwist/sizing/targets.h"
#include "hextwist/sizing/techniques/wish_internal.h"

namespace hextwist {

SizesOfAll::SizesOfAll(const MeshedModel& of_input, const Request& of_request)
    : input(of_input),
      request(of_request),
      wish(std::make_shared<const SizeWish>(of_input, of_request)),
      region(region_target(of_input, of_request.target, told)) {
  const std::vector<std::uint8_t> in_zone = zone();
  too_large = wish->too_large(input.mesh, in_zone);
  too_far = wish->nodes_too_far_apart(input.mesh, in_zone);
}

std::vector<std::uint8_t> SizesOfAll::zone() const {
  std::vector<std::uint8_t> in_zone(input.mesh.hexes.size(), wish->is_everywhere());
  for (const Index h : region) in_zone[h] = 1;
  return in_zone;
}

SizeReport SizesOfAll::report(std::vector<Index> hexes) const {
  return size_report(input.mesh, std::move(hexes), wish->field());
}

double SizesOfAll::least_more() const {
  return wish->least_more(input.mesh, too_large);
}

DirectionSizes SizesOfAll::directions(std::span<const Index> hexes) const {
  return direction_sizes(input.mesh, hexes, wish->field());
}

SizesInPart::SizesInPart(const SizesOfAll& of, std::span<const Index> nodes, std::span<const Index> hexes)
    : all(of),
      n_outside(of.input.mesh.n_hexes() - static_cast<Index>(hexes.size())),
      n_base_outside(n_outside),
      outside(of.report(difference(of.region, std::vector<Index>(hexes.begin(), hexes.end())))) {
  const auto renumbered = [](auto& to, std::span<const Index> numbers, const auto& from) {
    for (auto item : from) {
      bool is_here = true;
      for (Index& n : item) is_here = (n = position_in(numbers, n)) >= 0 && is_here;
      if (is_here) to.push_back(item);
    }
  };
  for (const Index h : of.region)
    if (const Index there = position_in(hexes, h); there >= 0) region.push_back(there);
  const Target& wanted = of.request.target;
  if (is_solid(wanted.kind) || wanted.radius || wanted.depth.value_or(0) > 0) return;
  const CombinationTarget whole = sub_element_target(of.input, wanted, told_of_target);
  for (const Index n : whole.nodes)
    if (const Index there = position_in(nodes, n); there >= 0) target.nodes.push_back(there);
  renumbered(target.edges, nodes, whole.edges);
  renumbered(target.faces, nodes, whole.faces);
}

}  // namespace hextwist
