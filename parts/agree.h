// Whether parts have made of hexes between them what their owners made, and so what a single process would have made.
//
// All that a pass does to a hex depends on what the passes before have made of the hexes around it, not more than
// enough_rings (patch/patch_refine.h) away. Suppose that some part makes something else of one of its own hexes than a
// single process would. Take the first pass in which that happens anywhere, and such a part. One of the hexes that had
// a say was not the same there before that pass; it lies in the halo, and its owner, who had made no mistake so far,
// had it right. So the two have it differently: where all parts agree about the first enough_rings rings, with all that
// happened in them pass by pass, they are right. Whatever is decided otherwise says so (Report::by_whole), and is done
// with the whole mesh only. What is decided by numbers of all parts (sizing/among_parts.h) is right where these are: so
// all that was counted is compared, too, be it taken or not.
#pragma once

#include "hextwist/parts/local_mesh.h"
#include "hextwist/patch/patch_refine.h"

namespace hextwist {

/// Rings that are compared with their owners and must be the same.
inline constexpr int least_rings = enough_rings;
/// More rings than this make no sense.
inline constexpr int most_rings = 250;

/// What comes of a try. Throws Error where parts that have the whole mesh differ.
enum class Verdict { right, too_narrow, needs_all };
/// alike: rings that all parts have as their owners. n_rings: that were compared. by_whole: of any part. have_all:
/// every part has the whole mesh.
Verdict verdict_of(int alike, int n_rings, const std::string& by_whole, bool have_all);
/// Rings that stay for the next command: of the outermost that is right it is not known what is new at its rim.
int rings_to_keep(int alike, bool have_all);

/// NeedsWhole::why, where not even so many rings were enough.
std::string depends_on_far(int n_rings);

/// Rings to begin with. wished: by the user.
int first_rings(int wished, int depth, std::size_t n_commands);

/// What a part has made of a hex in its halo.
struct Made {
  std::int64_t hex = 0;  ///< id in the input mesh
  std::uint64_t digest = 0;
};

/// What must be known of the hexes of a halo to compare them: per other part, and the ring of each.
struct HaloMade {
  std::vector<std::vector<Made>> of;
  std::vector<std::vector<std::uint8_t>> ring;
};
HaloMade made_of_halo(const LocalMesh& local, std::span<const std::uint64_t> digest, int n_parts);

/// Of a part's own hexes: does another have the same? base: of the part.
std::vector<std::uint8_t> is_same(std::span<const Made> theirs, const BaseHexes& base,
                                  std::span<const std::uint64_t> digest);

}  // namespace hextwist
