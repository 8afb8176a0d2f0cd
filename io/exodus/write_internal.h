// The parts of writing an Exodus II file.
#pragma once

#include <limits>

#include "hextwist/base/replacement.h"
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

/// As the library takes texts: of names it writes what stands behind them too.
struct TextsWritten {
  std::vector<std::string> padded;
  std::vector<char*> pointers;
  explicit TextsWritten(std::vector<std::string> texts) : padded(std::move(texts)) {
    for (std::string& text : padded) {
      text.resize(std::max<std::size_t>(text.size(), 256) + 1);
      pointers.push_back(text.data());
    }
  }
};

/// The file while it is written: calls of the library that say when they fail.
class ExodusOutput {
 public:
  explicit ExodusOutput(const Replacement& to) : to_(to) {
    if (to.direct()) to.fail("is not an ordinary file, as Exodus II needs");
  }
  ~ExodusOutput() {
    if (file_ >= 0) ex_close(file_);
  }
  ExodusOutput(const ExodusOutput&) = delete;
  ExodusOutput& operator=(const ExodusOutput&) = delete;

  int file() const { return file_; }
  [[noreturn]] void fail() const { to_.fail("cannot be written (disk full?)"); }
  void check(int status) const {
    if (status < 0) fail();
  }
  /// wide: with ids or properties beyond 32 bits.
  void create(bool wide, std::size_t n_hexes, int nodes_per_hex);
  void put_sizes(ex_init_params sizes, const std::string& title, std::size_t longest_name);
  /// Of one axis, for nodes from this 0-based place on.
  void put_coordinates(int axis, std::size_t first, std::span<const double> values);
  /// names: none, x y z.
  void put_coordinate_names(const std::vector<std::string>& names);
  void put_block(const ExodusPart& part, const std::string& type, std::int64_t n, int nodes_each,
                 std::int64_t n_attributes);
  void put_name(ex_entity_type type, std::int64_t id, const std::string& name);
  void put_set(ex_entity_type type, std::int64_t id, const std::string& name, const std::vector<int>& members,
               const std::vector<int>& sides, const std::vector<double>& factors);
  /// id(0) .. id(n_items - 1), in order.
  template <class F>
  void put_map(ex_entity_type type, std::size_t n_items, F&& id) {
    const auto put = [&]<class T>(std::vector<T> ids) {
      in_pieces(n_items, [&](std::size_t first, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<T>(id(first + i));
        check(ex_put_partial_id_map(file_, type, exodus_position(first), exodus_position(n - 1), ids.data()));
      });
    };
    is_wide_ ? put(std::vector<std::int64_t>(exodus_piece)) : put(std::vector<int>(exodus_piece));
  }
  void close();

 private:
  void clear_behind_names();
  const Replacement& to_;
  int file_ = -1;
  bool is_wide_ = false;
};
constexpr std::int64_t highest_narrow_id = std::numeric_limits<std::int32_t>::max();

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
  /// Are there ids or properties beyond 32 bits?
  bool are_wide() const;
  const FileResults& extras() const { return extras_; }

  void write_records(const ExodusTarget& to) const;
  void write_properties(const ExodusTarget& to) const;
  void write_results(const ExodusTarget& to);
  /// Of them the moment, if there is that one, and what the whole has then.
  void put_globals(const ExodusTarget& to, std::size_t t) const;
  /// Only what variables there are. is_on: per element block, for each variable of hexes, whether the
  /// block has values of it.
  void declare_results(const ExodusTarget& to, std::vector<int>& is_on) const;
  std::size_t n_variables(Field::On on) const { return (on == Field::On::node ? on_nodes_ : on_hexes_).size(); }

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

/// Says which groups are called otherwise in the file, and which element block the hexes of no block are in.
void say_exodus_names(const Mesh& mesh, std::vector<std::string>& notices);
void say_rest_block(std::int64_t n_hexes, std::int64_t id, std::vector<std::string>& notices);

/// At most as long as the library takes.
std::string exodus_name(const std::string& name);

}  // namespace hextwist::io
