#include "hextwist/mesh/fill/plan_internal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "hextwist/base/sorted.h"

namespace hextwist::fill {
namespace {

std::string ids_text(const std::vector<int>& ids) {
  std::string text;
  for (std::size_t i = 0; i < ids.size() && i < 5; ++i) text += (i ? " " : "") + std::to_string(ids[i]);
  return text + (ids.size() > 5 ? " ..." : "");
}

std::string surfaces_text(const std::vector<int>& ids) {
  return (ids.size() == 1 ? "surface " : "surfaces ") + ids_text(ids);
}

bool has(const std::vector<int>& sorted, int id) {
  return std::ranges::binary_search(sorted, id);
}

int side_with(const SurfaceFacts& surface, int curve) {
  for (int k = 0; k < 4; ++k)
    for (const Step& step : (*surface.sides)[k])
      if (step.curve == curve) return k;
  return -1;
}

/// One volume and its surfaces.
class Search {
 public:
  Search(const Facts& facts, int volume)
      : facts_(facts), volume_(volume), surfaces_(facts.model.adjacent({3, volume}, 2)) {}

  /// All sweeps of the volume; if there are none, why() says what was in the way of the best try.
  std::vector<Sweep> sweeps() {
    std::vector<Sweep> found;
    std::set<std::vector<int>> tried;
    for (const int seed : surfaces_)
      for (const bool flood : {true, false}) {
        const std::vector<int> caps = flood ? smooth_part(seed) : std::vector<int>{seed};
        if (!tried.insert(caps).second) continue;
        Sweep sweep{.volume = volume_};
        sweep.caps[0] = caps;
        if (complete(sweep)) found.push_back(std::move(sweep));
      }
    return found;
  }
  std::string why() const {
    if (!why_.empty()) return why_;
    return "none of its " + std::to_string(surfaces_.size()) +
           " surfaces is linked to another one by sides that all have four corners";
  }

 private:
  const Facts& facts_;
  int volume_;
  std::vector<int> surfaces_;  // ascending
  std::string why_;

  const SurfaceFacts& of(int surface) const { return facts_.surfaces[surface - 1]; }

  /// The other surface of the volume at a curve; 0 where there is none, or where more than two meet.
  int across(int surface, int curve) const {
    int other = 0;
    for (const int beside : facts_.model.adjacent({1, curve}, 2))
      if (beside != surface && has(surfaces_, beside)) other = other == 0 ? beside : -1;
    return std::max(other, 0);
  }

  /// Does the skin of the volume go on over the curve with a bend of less than 40 degrees?
  bool is_smooth(int a, int b, int curve) const {
    const Vec3 p = facts_.point_at(curve, 0.41);
    // How two surfaces are turned against each other is known by where they lie, not by their normals alone, which
    // need not point out of this volume.
    const auto into = [&](int surface) {
      const Vec3 n = facts_.model.normal(surface, facts_.model.project({2, surface}, p).parameters);
      const Vec3 along = facts_.model.tangent(curve, facts_.parameter_at(curve, 0.41));
      const Vec3 side = n.cross(along).normalized() * (1e-3 * facts_.curves[curve - 1].length);
      const bool left =
          facts_.model.project({2, surface}, p + side).distance < facts_.model.project({2, surface}, p - side).distance;
      return Vec3((left ? 1 : -1) * side.normalized());
    };
    return into(a).dot(into(b)) < -std::cos(40 * std::numbers::pi / 180);
  }

  /// Surfaces of the volume that one can get to from this one, ascending: over curves where goes_on(surface, other,
  /// curve).
  template <class GoesOn>
  std::vector<int> reached(int seed, const GoesOn& goes_on) const {
    std::vector<int> part{seed}, next{seed};
    while (!next.empty()) {
      const int surface = next.back();
      next.pop_back();
      for (const Chain& loop : of(surface).loops)
        for (const Step& step : loop) {
          const int other = across(surface, step.curve);
          if (other == 0 || std::ranges::find(part, other) != part.end() || !goes_on(surface, other, step.curve))
            continue;
          part.push_back(other);
          next.push_back(other);
        }
    }
    std::ranges::sort(part);
    return part;
  }
  std::vector<int> smooth_part(int seed) const {
    return reached(seed, [&](int surface, int other, int curve) { return is_smooth(surface, other, curve); });
  }

  /// Fills in sides and the other caps. False, with a reason, where that does not come out.
  bool complete(Sweep& sweep) {
    const std::vector<int>& near = sweep.caps[0];
    std::set<int> along, sides;  // curves that lead from end to end; surfaces that have them
    std::vector<int> next;
    const auto add = [&](int surface, int side) {
      sides.insert(surface);
      for (const Step& step : (*of(surface).sides)[side])
        if (along.insert(step.curve).second) next.push_back(step.curve);
    };
    // From the rim of the caps outwards; smooth neighbours of a side beyond its far rim are sides as well.
    std::vector<std::pair<int, int>> rims;  // a surface and a curve from which it is to be crossed
    for (const int cap : near)
      for (const Chain& loop : of(cap).loops)
        for (const Step& step : loop) {
          const int other = across(cap, step.curve);
          if (!has(near, other)) rims.emplace_back(other, step.curve);
        }
    if (rims.empty()) return false;
    std::set<std::pair<int, int>> crossed;
    while (!rims.empty() || !next.empty()) {
      if (!rims.empty()) {
        const auto [surface, curve] = rims.back();
        rims.pop_back();
        if (!crossed.insert({surface, curve}).second) continue;
        if (surface == 0 || !of(surface).sides) return reason(near, surface);
        const int side = side_with(of(surface), curve);
        if (side < 0) return false;
        add(surface, (side + 1) % 4);
        add(surface, (side + 3) % 4);
        for (const Step& step : (*of(surface).sides)[(side + 2) % 4]) {
          const int other = across(surface, step.curve);
          if (other > 0 && !has(near, other) && of(other).sides && is_smooth(surface, other, step.curve))
            rims.emplace_back(other, step.curve);
        }
        continue;
      }
      const int curve = next.back();
      next.pop_back();
      for (const int surface : facts_.model.adjacent({1, curve}, 2)) {
        if (!has(surfaces_, surface)) continue;
        if (!of(surface).sides || has(near, surface)) return reason(near, surface);
        const int side = side_with(of(surface), curve);
        if (side < 0) return false;
        add(surface, side);
        add(surface, (side + 2) % 4);
      }
    }
    for (const int surface : sides) {
      int n = 0;
      std::array<bool, 4> is_along{};
      for (int k = 0; k < 4; ++k) {
        const Chain& chain = (*of(surface).sides)[k];
        const auto m = std::ranges::count_if(chain, [&](const Step& step) { return along.contains(step.curve); });
        is_along[k] = m > 0;
        if (m > 0 && m < std::ssize(chain)) return false;
        n += m > 0;
      }
      if (n != 2 || is_along[0] != is_along[2]) return false;
    }
    sweep.sides.assign(sides.begin(), sides.end());
    sweep.along = columns(near, along);
    std::vector<int> far;
    for (const int surface : surfaces_)
      if (!sides.contains(surface) && !has(near, surface)) far.push_back(surface);
    if (far.empty()) return false;
    // Caps at one end go on smoothly, else hexes at the edges between them would be flat.
    if (!hang_together(far, false)) {
      note("seen from " + surfaces_text(near) + ", " + surfaces_text(far) + " are ends that do not hang together");
      return false;
    }
    if (!hang_together(far, true) || !hang_together(near, true)) {
      note("seen from " + surfaces_text(near) + ", there are edges between " + surfaces_text(far) +
           " at the other end");
      return false;
    }
    for (const int cap : far)
      if (!of(cap).odd.empty() || of(cap).loops.empty()) return false;
    sweep.caps[1] = far;
    return sweep.caps[0].size() == 1 || far.size() == 1 || find_partners(sweep);
  }

  /// From the vertices of these caps along such curves, as far as these go.
  std::vector<Chain> columns(const std::vector<int>& caps, const std::set<int>& along) const {
    std::set<int> starts;
    for (const int cap : caps)
      for (const Chain& loop : of(cap).loops)
        for (const Step& step : loop) starts.insert(facts_.start(step));
    std::vector<Chain> result;
    for (int at : starts) {
      Chain chain;
      for (bool found = true; found && chain.size() <= along.size();) {
        found = false;
        for (const int curve : along) {
          const CurveFacts& own = facts_.curves[curve - 1];
          if (own.is_closed() || (!chain.empty() && chain.back().curve == curve)) continue;
          if (own.first != at && own.last != at) continue;
          chain.push_back({curve, own.first == at});
          at = facts_.end(chain.back());
          found = true;
          break;
        }
      }
      if (!chain.empty()) result.push_back(std::move(chain));
    }
    return result;
  }

  void note(const std::string& text) {
    if (why_.empty()) why_ = text;
  }
  bool reason(const std::vector<int>& near, int surface) {
    // The largest cap with the fewest neighbours that do not fit would be the best reason; the first one does.
    if (surface > 0 && near.size() == 1 && !of(near[0]).sides &&
        of(near[0]).loops.size() + of(near[0]).seams.size() > 0)
      note("seen from surface " + std::to_string(near[0]) + ", surface " + std::to_string(surface) +
           (of(surface).odd.empty() ? " does not have four corners" : " cannot be a side: " + of(surface).odd));
    return false;
  }

  bool hang_together(const std::vector<int>& part, bool smoothly) const {
    const auto goes_on = [&](int surface, int other, int curve) {
      return has(part, other) && (!smoothly || is_smooth(surface, other, curve));
    };
    return reached(part.front(), goes_on).size() == part.size();
  }

  std::vector<int> curves_between(const std::vector<int>& caps) const {
    std::vector<int> curves;
    for (const int cap : caps)
      for (const Chain& loop : of(cap).loops)
        for (const Step& step : loop)
          if (has(caps, across(cap, step.curve))) curves.push_back(step.curve);
    return sorted_unique(curves);
  }

  /// Both ends have several caps: the curves between them have to answer each other.
  bool find_partners(Sweep& sweep) {
    std::vector<Vec3> from, to;
    for (const int surface : sweep.sides)
      for (int k = 0; k < 4; ++k) {
        const Chain& here = (*of(surface).sides)[k];
        if (!std::ranges::all_of(here, [&](const Step& s) { return has(sweep.caps[0], across(surface, s.curve)); }))
          continue;
        const Chain there = reversed((*of(surface).sides)[(k + 2) % 4]);
        if (here.size() != there.size()) return false;
        const auto a = facts_.samples(here, 8), b = facts_.samples(there, 8);
        from.insert(from.end(), a.begin(), a.end());
        to.insert(to.end(), b.begin(), b.end());
      }
    if (from.size() < 3) return false;
    Vec3 center = Vec3::Zero(), center_to = Vec3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
      center += from[i] / static_cast<double>(from.size());
      center_to += to[i] / static_cast<double>(from.size());
    }
    Eigen::MatrixXd a(from.size(), 3), b(from.size(), 3);
    for (std::size_t i = 0; i < from.size(); ++i) {
      a.row(static_cast<Index>(i)) = from[i] - center;
      b.row(static_cast<Index>(i)) = to[i] - center_to;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr;
    qr.setThreshold(1e-6);
    const Eigen::Matrix3d map = qr.compute(a).solve(b);
    const auto image = [&](const Vec3& p) { return Vec3(center_to + map.transpose() * (p - center)); };
    const std::vector<int> inner = curves_between(sweep.caps[0]), other = curves_between(sweep.caps[1]);
    for (const int curve : inner) {
      const double near_enough = 1e-3 * facts_.curves[curve - 1].length;
      const auto meets = [&](int candidate, bool same_way) {
        for (const double part : {0.0, 0.3, 0.7, 1.0})
          if ((image(facts_.point_at(curve, part)) - facts_.point_at(candidate, same_way ? part : 1 - part)).norm() >
              near_enough)
            return false;
        return true;
      };
      bool found = false;
      for (const int candidate : other)
        for (const bool same_way : {true, false})
          if (!found && meets(candidate, same_way)) {
            sweep.partners.push_back({curve, candidate, same_way});
            found = true;
          }
      if (!found) break;
    }
    if (sweep.partners.size() == inner.size() && inner.size() == other.size()) return true;
    note(surfaces_text(sweep.caps[0]) + " and " + surfaces_text(sweep.caps[1]) +
         " at its ends are divided differently");
    return false;
  }
};

bool is_ball(const Model& model, int volume) {
  const std::vector<int> surfaces = model.adjacent({3, volume}, 2);
  return surfaces.size() == 1 && model.type({2, surfaces[0]}) == "sphere" && model.adjacent({3, volume}, 0).size() == 2;
}

/// Turned all the way round: tubes and flat rings that hang together by circles, or a torus.
bool is_turned(const Facts& facts, const std::vector<int>& surfaces) {
  if (surfaces.size() == 1) return facts.surfaces[surfaces[0] - 1].is_torus;
  return std::ranges::all_of(surfaces, [&](int id) {
    const SurfaceFacts& surface = facts.surfaces[id - 1];
    return surface.is_annulus || (surface.is_tube && surface.loops[0].size() == 1 && surface.loops[1].size() == 1);
  });
}

bool has_pole(const Facts& facts, const Sweep& sweep) {
  return std::ranges::any_of(sweep.caps, [&](const std::vector<int>& caps) {
    return std::ranges::any_of(caps, [&](int cap) { return facts.surfaces[cap - 1].has_poles; });
  });
}

/// What is on the ends of an axis is decided by the volume around it alone.
bool owns_ends(const Model& model, const Axis& axis, int volume, const std::vector<int>& filled, std::string& why) {
  for (const AxisEnd& end : axis.ends)
    for (const int other : model.adjacent({2, end.surface}, 3))
      if (other != volume && std::ranges::find(filled, other) != filled.end()) {
        why = "it is turned about an axis that it touches, and shares surface " + std::to_string(end.surface) +
              " there with volume " + std::to_string(other);
        return false;
      }
  return true;
}

}  // namespace

bool is_regular(const SurfaceFacts& surface) {
  return surface.sides || surface.is_disc || surface.is_ring;
}

std::vector<Sweep> find_sweeps(const Facts& facts, const std::vector<int>& volumes, bool can_pave) {
  std::vector<Sweep> result;
  std::string refused;
  int n_refused = 0;
  for (const int volume : volumes) {
    if (is_ball(facts.model, volume)) {
      result.push_back({.volume = volume, .is_ball = true});
      continue;
    }
    Search search(facts, volume);
    std::vector<Sweep> sweeps = search.sweeps();
    const auto n_to_pave = [&](const Sweep& sweep) {
      std::ptrdiff_t n = 0;
      for (const auto& caps : sweep.caps)
        n += std::ranges::count_if(caps, [&](int cap) { return !is_regular(facts.surfaces[cap - 1]); });
      return n;
    };
    std::string why = search.why();
    if (!sweeps.empty() && !can_pave && std::ranges::all_of(sweeps, n_to_pave)) {
      std::vector<int> caps = sweeps.front().caps[0];
      std::erase_if(caps, [&](int cap) { return is_regular(facts.surfaces[cap - 1]); });
      if (caps.empty()) caps = sweeps.front().caps[1];
      why = surfaces_text(caps) + " is to be paved with quads, by the program gmsh, which is not installed";
      sweeps.clear();
    }
    const std::vector<int> around = facts.model.adjacent({3, volume}, 2);
    // No quads of a cap would lie well around a pole.
    if (std::ranges::all_of(sweeps, [&](const Sweep& sweep) { return has_pole(facts, sweep); })) {
      std::optional<Axis> axis = find_axis(facts, volume, why);
      if (axis && !can_pave) why = "its section is to be paved with quads, by the program gmsh, which is not installed";
      if (axis && can_pave && owns_ends(facts.model, *axis, volume, volumes, why)) {
        result.push_back({.volume = volume, .is_turned = true, .axis = std::move(axis), .sides = around});
        continue;
      }
    }
    if (sweeps.empty() && is_turned(facts, around)) {
      if (can_pave || around.size() == 1) {
        result.push_back({.volume = volume, .is_turned = true, .sides = around});
        continue;
      }
      why = "its section is to be paved with quads, by the program gmsh, which is not installed";
    }
    if (sweeps.empty()) {
      if (++n_refused <= 5)
        refused += (refused.empty() ? "" : "; ") + ("volume " + std::to_string(volume) + ": " + why);
      continue;
    }
    result.push_back(*std::ranges::min_element(sweeps, {}, [&](const Sweep& sweep) {
      return std::pair(n_to_pave(sweep), sweep.caps[0].size() + sweep.caps[1].size());
    }));
  }
  if (n_refused > 5) refused += "; and " + std::to_string(n_refused - 5) + " more";
  if (n_refused > 0)
    throw Error(refused +
                ". Cut it in the CAD program into pieces that can be swept (and glue them: 'set glue on'), or mesh it "
                "elsewhere and say 'import mesh'");
  return result;
}

std::vector<int> find_intervals(const Facts& facts, const std::vector<Sweep>& sweeps, double size, int intervals,
                                double most_turning) {
  std::vector<int> n(facts.curves.size(), 0);
  for (std::size_t c = 0; c < n.size(); ++c) {
    const CurveFacts& curve = facts.curves[c];
    if (curve.is_point || curve.first == 0) continue;
    const double wished = intervals > 0 ? intervals : curve.length / size;
    n[c] =
        static_cast<int>(std::clamp(std::max(std::round(wished), std::ceil(curve.turning / most_turning)), 1.0, 1e6));
    if (curve.is_closed()) n[c] = std::max(n[c], 4);
  }
  struct Balance {
    Chain a, b;
  };
  std::vector<Balance> balances;
  std::vector<std::pair<Chain, int>> multiples;
  std::vector<int> even;
  std::set<int> seen;
  for (const Sweep& sweep : sweeps) {
    for (const int id : sweep.is_turned ? sweep.sides : std::vector<int>()) {
      const SurfaceFacts& surface = facts.surfaces[id - 1];
      if (surface.is_torus) multiples.emplace_back((*surface.sides)[0], 4);
      // Its section is paved.
      for (const int seam : surface.seams)
        if (!surface.is_torus) even.push_back(seam);
      if (surface.is_annulus) balances.push_back({surface.loops[0], surface.loops[1]});
    }
    if (sweep.axis)
      for (const int rim : sweep.axis->rims) {
        balances.push_back({{{rim, true}}, {{sweep.axis->rims[0], true}}});
        multiples.emplace_back(Chain{{rim, true}}, 8);
      }
    for (std::size_t i = 1; i < sweep.along.size(); ++i) balances.push_back({sweep.along[0], sweep.along[i]});
    for (const Partner& partner : sweep.partners) balances.push_back({{{partner.curve}}, {{partner.other}}});
    for (const auto* surfaces : {&sweep.sides, &sweep.caps[0], &sweep.caps[1]})
      for (const int id : *surfaces) {
        const SurfaceFacts& surface = facts.surfaces[id - 1];
        if ((sweep.is_turned && surface.is_annulus) || !seen.insert(id).second) continue;
        if (surface.sides) {
          const auto& sides = *surface.sides;
          balances.push_back({sides[0], sides[2]});
          if (!surface.is_tube) balances.push_back({sides[1], sides[3]});
        } else if (surface.is_disc) {
          multiples.emplace_back(surface.loops[0], 4);
        } else if (surface.is_ring) {
          balances.push_back({surface.loops[0], surface.loops[1]});
        } else {
          for (const Chain& loop : surface.loops)
            for (const Step& step : loop) {
              even.push_back(step.curve);
              if (loop.size() < 3) n[step.curve - 1] = std::max(n[step.curve - 1], loop.size() == 1 ? 6 : 4);
            }
        }
      }
  }
  bool changed = true;
  const auto sum = [&](const Chain& chain) {
    int total = 0;
    for (const Step& step : chain) total += n[step.curve - 1];
    return total;
  };
  const auto raise = [&](const Chain& chain, int by) {
    for (; by > 0; --by, changed = true) {
      const Step& longest = *std::ranges::max_element(
          chain, {}, [&](const Step& step) { return facts.curves[step.curve - 1].length / n[step.curve - 1]; });
      if (++n[longest.curve - 1] > 1000000)
        throw Error("the numbers of intervals of opposite curves cannot be made to agree (curve " +
                    std::to_string(longest.curve) + ")");
    }
  };
  for (int round = 0; changed; ++round) {
    if (round > 10000) throw Error("the numbers of intervals of opposite curves cannot be made to agree");
    changed = false;
    for (const auto& [a, b] : balances) {
      raise(a, sum(b) - sum(a));
      raise(b, sum(a) - sum(b));
    }
    for (const int curve : even)
      if (n[curve - 1] % 2) {
        ++n[curve - 1];
        changed = true;
      }
    for (const auto& [loop, of] : multiples) raise(loop, (of - sum(loop) % of) % of);
  }
  return n;
}

}  // namespace hextwist::fill
