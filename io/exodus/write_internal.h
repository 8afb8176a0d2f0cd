// The parts of writing an Exodus II file.
#pragma once

#include "hextwist/io/exodus/exodus_internal.h"

namespace hextwist {
struct FilePart;  // io/file_part.h
}

namespace hextwist::io {

/// An element block of the file.
struct ExodusPart {
  int id;  ///< of our block
  std::int64_t in_file;
  std::string name;
  std::span<const Index> hexes;
  std::vector<Index> own = {};     ///< what `hexes` is where it is no list of the mesh
  std::int64_t in_whole = 0;       ///< hexes, also of the other files that a mesh is split into
  std::vector<Index> others = {};  ///< instead of hexes: other elements of one type
  std::string type = {};           ///< of these, in the file

  std::size_t size() const { return hexes.size() + others.size(); }
};

struct ExodusTarget {
  int file = -1;  ///< of the library
  const Mesh& mesh;
  std::span<const ExodusPart> parts;
  std::function<void(int status)> check;  ///< throws where a call has failed
  std::vector<std::string>& notices;
};

/// Values of the mesh and of what its file had, at all times; written when everything else is there.
class ExodusValues {
 public:
  /// Says what has to be left out, and names that had to change.
  ExodusValues(const Mesh& mesh, std::vector<std::string>& notices);

  /// Distribution factors of a set: none where it has none, one per node, four per side.
  std::vector<double> factors(const NodeSet& set);
  std::vector<double> factors(const SideSet& set);
  /// Has it factors, though perhaps no members here?
  template <class Set>
  bool has_factors(const Set& set) const {
    const SetExtras* of = extras_of(set);
    return of && !of->factors.empty() && (of->factors.size() == 1 || has_places_);
  }
  std::vector<std::string> attributes(const ExodusPart& part) const;
  std::vector<double> attribute(const ExodusPart& part, const std::string& name) const;
  std::size_t longest_name() const;

  void write_records(const ExodusTarget& to) const;
  void write_properties(const ExodusTarget& to) const;
  void write_results(const ExodusTarget& to);

 private:
  struct Variable {
    std::string name;
    const std::vector<double>* now = nullptr;  ///< at the time of the mesh's fields
    const TimedValues* timed = nullptr;        ///< at all times
  };
  std::vector<Variable> variables(Field::On on, const std::vector<TimedValues>& timed);
  const SetExtras* extras_of(const NodeSet& set) const;
  const SetExtras* extras_of(const SideSet& set) const;
  template <class Groups>
  void write_sets(const ExodusTarget& to, ex_entity_type type, const Groups& groups);

  const Mesh& mesh_;
  std::vector<std::string>& notices_;
  FileResults none_;
  const FileResults& extras_;
  ExtrasNow now_;
  bool has_places_;
  std::vector<Field> fields_;  // of one component
  std::vector<double> times_;
  std::vector<Variable> on_nodes_, on_hexes_;
};

/// Of the whole that a file is a part of: ids in the file, and how many there are.
struct ExodusGlobals {
  std::vector<std::int64_t> block_ids, block_counts, node_set_ids, node_factors, side_set_ids, side_factors;
};
/// To be called when the sizes are written and nothing else is: the library moves what is there already.
void write_exodus_part(const ExodusTarget& to, const FilePart& part, const ExodusGlobals& globals,
                       std::span<const int> element_of_hex);

/// At most as long as the library takes.
std::string exodus_name(const std::string& name);

}  // namespace hextwist::io
