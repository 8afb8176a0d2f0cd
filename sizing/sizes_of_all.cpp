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
      region(region_target(of_input, of_request.target, told)),
      in_zone(wish->zone(of_input.mesh, region)),
      too_large(wish->too_large(of_input.mesh, in_zone)),
      too_far(wish->nodes_too_far_apart(of_input.mesh, in_zone)) {}

SizeReport SizesOfAll::report(std::vector<Index> hexes) const {
  return size_report(input.mesh, std::move(hexes), wish->field());
}

double SizesOfAll::least_more() const {
  return wish->least_more(input.mesh, too_large);
}

DirectionSizes SizesOfAll::directions(std::span<const Index> hexes) const {
  return direction_sizes(input.mesh, hexes, wish->field());
}

SizesInPart::SizesInPart(const SizesOfAll& of, std::span<const Index> part_nodes, std::span<const Index> hexes)
    : all(of),
      nodes(part_nodes),
      n_outside(of.input.mesh.n_hexes() - static_cast<Index>(hexes.size())),
      n_base_outside(n_outside),
      outside(of.report(difference(of.region, std::vector<Index>(hexes.begin(), hexes.end())))) {
  for (const Index h : of.region)
    if (const Index there = position_in(hexes, h); there >= 0) region.push_back(there);
}

CombinationTarget SizesInPart::target(std::vector<std::string>& told) const {
  const CombinationTarget whole = sub_element_target(all.input, all.request.target, told);
  const auto put_here = [&](auto& to, const auto& from) {
    for (auto item : from) {
      bool is_here = true;
      for (Index& n : item) is_here = (n = position_in(nodes, n)) >= 0 && is_here;
      if (is_here) to.push_back(item);
    }
  };
  CombinationTarget here;
  for (const Index n : whole.nodes)
    if (const Index there = position_in(nodes, n); there >= 0) here.nodes.push_back(there);
  put_here(here.edges, whole.edges);
  put_here(here.faces, whole.faces);
  return here;
}

}  // namespace hextwist
