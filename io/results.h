// What a file says beyond mesh, groups and the fields of one moment. Exodus II files hold results at several times,
// values on sets, attributes and records; other formats have none of that.
//
// It is kept as the file had it, beside the mesh, and shared by all meshes that come of that one. A refinement carries
// no more than, per hex, the hex of the file that it lies in (Mesh::file_hexes). What nodes, hexes and sides have of it
// now is looked up when somebody asks, at their places in the mesh of the file.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hextwist/geom/similarity.h"
#include "hextwist/mesh/locate.h"

namespace hextwist {

/// Values of one name: (*at[t])[i] at time t for node, hex or member i of the file; one list where they have no times.
struct TimedValues {
  std::string name;
  std::vector<std::shared_ptr<const std::vector<double>>> at;
};

/// Of a node set or a side set.
struct SetExtras {
  int id = 0;                   ///< the set's, in the mesh
  std::vector<Index> nodes;     ///< members, ascending: those of a node set
  std::vector<Side> sides;      ///< of a side set
  std::vector<double> factors;  ///< distribution factors: one per node, four per side (its corners as files order them)
  std::vector<TimedValues> variables;  ///< per member
};

struct FileResults {
  enum class Of { block, node_set, side_set };
  /// Points and hexes of the file, in the order in which they were read; none where nothing below needs them.
  std::shared_ptr<const Mesh> mesh;
  std::vector<double> times;
  std::size_t step = 0;                 ///< the one that Mesh::fields are of
  std::vector<TimedValues> on_nodes;    ///< variables; not finite where there is no value
  std::vector<TimedValues> on_hexes;    ///< likewise
  std::vector<TimedValues> of_all;      ///< global: one value each
  std::vector<TimedValues> attributes;  ///< of hexes, without times
  struct OfBlock {
    int id;
    std::vector<std::string> attributes;  ///< those that it has, in order
  };
  std::vector<OfBlock> blocks;
  std::vector<SetExtras> node_sets, side_sets;
  struct Property {
    Of of;
    std::string name;
    std::vector<std::pair<int, std::int64_t>> values;  ///< by id in the mesh
  };
  std::vector<Property> properties;
  /// Ids of the file that no int holds.
  struct WideId {
    Of of;
    int id;
    std::int64_t in_file;
  };
  std::vector<WideId> wide_ids;
  std::string title;
  std::vector<std::string> coordinate_names, info;
  std::vector<std::array<std::string, 4>> qa;  ///< program, version, date, time

  bool empty() const;
  /// Does it have values for nodes, hexes or sides?
  [[gnu::visibility("hidden")]] bool has_places() const;
  [[gnu::visibility("hidden")]] std::int64_t in_file(Of of, int id) const;
};

/// What of it would be lost in a format without a place for it: "2 more time steps (0, 1), distribution factors of
/// sideset 3"; empty when nothing that counts.
std::string extras_text(const FileResults& extras);

/// What of it each part of a mesh keeps: what is of the whole, and the moment that the fields are of. lost: names the
/// rest as extras_text() does.
std::shared_ptr<const FileResults> results_of_parts(const FileResults& results, std::string& lost);

/// From now on the results are of this mesh as it is, and its hexes their own in the file.
void place_in_itself(Mesh& mesh, FileResults& results);

/// Another mesh than the one with these results, `before`.
struct ResultsTo {
  const Mesh& before;
  const Mesh& now;  ///< whose file_hexes are some hexes of the file nearby
  /// Those before that a hex now is, lies in or is made of; valid for as long as this is.
  std::function<std::span<const Index>(Index hex)> hexes_before;
  /// Values of a name on the hexes now, from those on the hexes before.
  std::function<std::vector<double>(const std::string& name, std::vector<double> values)> on_hexes;
};
/// What `before` has of its file, on the hexes, nodes and sets of `now`: as if `now` had been written and read again.
/// For meshes whose hexes are not each in one of the file. Nodal values are those at the place of the node; a side of a
/// coarser hex has the average by area of what was there. They are to be placed in `now` (place_in_itself()).
std::shared_ptr<FileResults> results_on(const ResultsTo& to);

/// Values now, of a mesh that has extras and knows the hexes of the file.
class ExtrasNow {
 public:
  /// extras: those of the mesh, or empty.
  ExtrasNow(const Mesh& mesh, const FileResults& extras) : mesh_(mesh), of_(extras) {}
  /// False: the mesh has not kept where its hexes lie in the file.
  bool knows() const { return mesh_.file_hexes.size() == mesh_.hexes.size(); }

  std::vector<double> on_nodes(const std::vector<double>& of_file);
  std::vector<double> on_hexes(const std::vector<double>& of_file) const;
  /// Per node of a set now, from values of its members then; `none` for who has no member around.
  std::vector<double> in_set(std::span<const Index> nodes, const SetExtras& set, const std::vector<double>& of_members,
                             double none);
  /// Per side, from values of the sides then.
  std::vector<double> in_set(std::span<const Side> sides, const SetExtras& set, const std::vector<double>& of_members,
                             double none) const;
  /// Four per side.
  std::vector<double> factors(std::span<const Side> sides, const SetExtras& set) const;

 private:
  struct NodeNow {
    Hex nodes{};  // of the file
    std::array<double, 8> weight{};
  };
  const std::vector<NodeNow>& nodes();
  /// The side then that a side now lies on: a position among those of the set, -1.
  Index side_then(const Side& side, const SetExtras& set) const;

  const Mesh& mesh_;
  const FileResults& of_;
  std::vector<NodeNow> nodes_;  // when asked for
};

/// The same of a file whose mesh was moved as move() does.
std::shared_ptr<const FileResults> moved(const FileResults& results, const Similarity& similarity);

/// The nodal and hex fields of a moment: those that the file has at this time in place of those of the mesh with the
/// same names.
void take_step(Mesh& mesh, std::size_t step);

}  // namespace hextwist
