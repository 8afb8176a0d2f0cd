// OpenFOAM's polyMesh: points, faces, owner, neighbour and boundary, text, and zones (OpenFOAM User Guide, "Mesh
// description"). A mesh is named by a file case.foam, as ParaView wants it, beside constant/polyMesh.
//
// Cells of six faces with four corners are hexes. Patches are side sets, cell zones blocks, face zones side sets, point
// zones node sets; they are numbered as they come.
#include <limits>

#include "hextwist/base/sorted.h"
#include "hextwist/io/group_names.h"
#include "hextwist/io/openfoam/openfoam_internal.h"

namespace hextwist::io {
namespace {

/// Words, numbers and brackets of one of OpenFOAM's files; comments are skipped.
class FoamCursor {
 public:
  explicit FoamCursor(const Bytes& bytes) : in_(bytes) { header(); }

  bool more() {
    skip();
    return in_.at < in_.end;
  }
  /// A bracket or semicolon, or a run of other characters; a text in quotes.
  std::string_view token() {
    skip();
    start_ = in_.at;
    if (in_.at == in_.end) return {};
    if (std::string_view("(){};").find(*in_.at) != std::string_view::npos) return {in_.at++, 1};
    const bool quoted = *in_.at == '"';
    if (quoted) {
      const char* from = ++in_.at;
      while (in_.at < in_.end && *in_.at != '"') ++in_.at;
      const std::string_view text(from, static_cast<std::size_t>(in_.at - from));
      if (in_.at < in_.end) ++in_.at;
      return text;
    }
    const char* from = in_.at;
    while (in_.at < in_.end && !Cursor::blank(*in_.at) &&
           std::string_view("(){};\"").find(*in_.at) == std::string_view::npos)
      ++in_.at;
    return {from, static_cast<std::size_t>(in_.at - from)};
  }
  void expect(std::string_view wanted) {
    const std::string_view found = token();
    if (found != wanted) fail("expected '" + std::string(wanted) + "', found " + shown(found));
  }
  std::int64_t integer(const char* what) {
    const std::string_view text = token();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size() || text.empty())
      fail(std::string("expected ") + what + ", found " + shown(text));
    return value;
  }
  double real(const char* what) {
    const std::string_view text = token();
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size() || text.empty())
      fail(std::string("expected ") + what + ", found " + shown(text));
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
    return value;
  }
  /// The number of items of a list, whose bracket is taken.
  std::size_t list(const char* what) {
    const std::int64_t n = integer((std::string("the number of ") + what).c_str());
    const std::size_t size = in_.check_count(n, 2, what);
    expect("(");
    return size;
  }
  /// A number, or 0 and 1 as words.
  std::int64_t number_or_flag(const char* what) {
    const FoamCursor before = *this;
    const std::string_view word = token();
    if (word == "true" || word == "on" || word == "yes") return 1;
    if (word == "false" || word == "off" || word == "no") return 0;
    *this = before;
    return integer(what);
  }
  /// List<label> n(...), n{value} or nothing.
  std::vector<std::int64_t> labels(const char* what) {
    std::string_view word = token();
    while (!word.empty() && !std::isdigit(static_cast<unsigned char>(word[0]))) {
      if (word == ";") return {};
      word = token();
    }
    std::int64_t n = 0;
    std::from_chars(word.data(), word.data() + word.size(), n);
    std::vector<std::int64_t> result(in_.check_count(n, 1, what));
    const std::string_view open = token();
    if (open == "{") {
      const std::int64_t value = number_or_flag(what);
      std::ranges::fill(result, value);
      expect("}");
    } else if (open == "(") {
      for (std::int64_t& value : result) value = number_or_flag(what);
      expect(")");
    } else if (!result.empty()) {
      fail("expected '(', found " + shown(open));
    }
    return result;
  }
  /// Skips what is in braces, the first of which is taken; its text.
  std::string rest_of_braces() {
    const char* from = in_.at;
    for (int depth = 1; depth > 0;) {
      const std::string_view word = token();
      if (word.empty() && in_.at == in_.end) fail("the file ends inside of braces");
      depth += word == "{" ? 1 : word == "}" ? -1 : 0;
    }
    return std::string(from, start_);
  }
  [[noreturn]] void fail(const std::string& what) const { in_.fail_at(start_, what); }
  const char* place() const { return start_; }
  std::string where() const { return in_.where(start_); }

 private:
  void skip() {
    for (;;) {
      in_.skip_blanks();
      const std::string_view rest(in_.at, in_.left());
      if (rest.starts_with("//")) {
        in_.line();
      } else if (rest.starts_with("/*")) {
        const auto end = rest.find("*/");
        in_.at = end == std::string_view::npos ? in_.end : in_.at + end + 2;
      } else {
        return;
      }
    }
  }
  void header() {
    if (token() != "FoamFile") fail("not a file of OpenFOAM: it does not begin with FoamFile");
    expect("{");
    const std::string text = rest_of_braces();
    const auto format = text.find("format");
    if (format != std::string::npos && trimmed(text.substr(format + 6)).starts_with("binary"))
      fail("is binary, and only text is read ('foamFormatConvert' after writeFormat ascii makes it that)");
  }

  Cursor in_;
  const char* start_ = nullptr;
};

/// Calls f(cursor) for the file.
template <class F>
void in_file(const std::filesystem::path& file, F&& f) {
  const Bytes bytes = read_bytes(file);
  unchanged_by(bytes, [&] {
    FoamCursor in(bytes);
    f(in);
    return 0;
  });
}

class FoamReader {
 public:
  explicit FoamReader(const std::filesystem::path& file) : folder_(poly_mesh_of(file)), name_(file.string()) {}

  MeshFile result() {
    points();
    faces();
    cells();
    boundary();
    zones("cellZones", "cellLabels", [&](const Zone& zone) {
      Block block{0, zone.name, {}};
      for (const std::int64_t label : zone.labels) {
        if (label < 0 || label >= n_cells_) fail("cell zone " + zone.name + " names cell " + std::to_string(label));
        block.hexes.push_back(static_cast<Index>(label));
      }
      sort_unique(block.hexes);
      out_.mesh.blocks.push_back(std::move(block));
    });
    zones("faceZones", "faceLabels", [&](const Zone& zone) {
      SideSet set{0, zone.name, {}};
      if (!zone.flips.empty() && zone.flips.size() != zone.labels.size())
        fail("face zone " + zone.name + " has " + std::to_string(zone.flips.size()) + " flips for " +
             counted(std::ssize(zone.labels), "face"));
      for (std::size_t i = 0; i < zone.labels.size(); ++i) {
        const std::int64_t label = zone.labels[i];
        if (label < 0 || label >= static_cast<std::int64_t>(owner_.size()))
          fail("face zone " + zone.name + " names face " + std::to_string(label));
        // Flipped: its normal is that of the neighbour, which faces at the boundary have not.
        const auto f = static_cast<std::size_t>(label);
        const bool flipped = !zone.flips.empty() && zone.flips[i] && side_of_neighbour_[f].hex >= 0;
        set.sides.push_back(flipped ? side_of_neighbour_[f] : side_of_face_[f]);
      }
      sort_unique(set.sides);
      out_.mesh.side_sets.push_back(std::move(set));
      patch_numbers_.push_back(-1);
    });
    zones("pointZones", "pointLabels", [&](const Zone& zone) {
      NodeSet set{0, zone.name, {}};
      for (const std::int64_t label : zone.labels) {
        if (label < 0 || label >= out_.mesh.n_nodes())
          fail("point zone " + zone.name + " names point " + std::to_string(label));
        set.nodes.push_back(static_cast<Index>(label));
      }
      sort_unique(set.nodes);
      out_.mesh.node_sets.push_back(std::move(set));
    });
    const auto as_they_come = [](const auto& groups) {
      std::vector<int> numbers(groups.size());
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i) + 1;
      return numbers;
    };
    number(out_.mesh.blocks, "block", as_they_come(out_.mesh.blocks));
    number(out_.mesh.node_sets, "nodeset", as_they_come(out_.mesh.node_sets));
    number(out_.mesh.side_sets, "sideset", patch_numbers_);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (entries_[i] != "type patch;") out_.extras.patches[out_.mesh.side_sets[i].id] = entries_[i];
    std::ranges::sort(out_.mesh.blocks, {}, &Block::id);
    std::ranges::sort(out_.mesh.side_sets, {}, &SideSet::id);
    std::ranges::sort(out_.mesh.node_sets, {}, &NodeSet::id);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }
  /// By their names, and those that unnamed groups have are none.
  template <class Group>
  static void number(std::vector<Group>& groups, const char* kind, const std::vector<int>& wishes) {
    std::vector<std::string> names;
    for (const Group& group : groups) names.push_back(group.name);
    const std::vector<int> ids = ids_by_name(kind, names, wishes);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      groups[i].id = ids[i];
      if (generated_id(groups[i].name, kind) == ids[i]) groups[i].name.clear();
    }
  }
  std::filesystem::path file(const char* name) const {
    const auto path = folder_ / name;
    std::error_code error;
    if (!std::filesystem::exists(path, error) && std::filesystem::exists(path.string() + ".gz", error))
      fail(path.string() + ".gz is compressed, and only plain files are read ('gunzip' makes it that)");
    return path;
  }

  void points() {
    in_file(file("points"), [&](FoamCursor& in) {
      out_.mesh.points.resize(in.list("points"));
      for (Vec3& point : out_.mesh.points) {
        in.expect("(");
        for (double& x : point) x = in.real("a coordinate");
        in.expect(")");
      }
      in.expect(")");
    });
  }

  void faces() {
    in_file(file("faces"), [&](FoamCursor& in) {
      faces_.resize(in.list("faces"));
      for (std::size_t f = 0; f < faces_.size(); ++f) {
        const std::int64_t n = in.integer("the number of corners");
        if (n != 4)
          in.fail("face " + std::to_string(f) + " has " + std::to_string(n) + " corners; the faces of hexes have 4");
        in.expect("(");
        for (Index& node : faces_[f]) {
          const std::int64_t point = in.integer("a point");
          if (point < 0 || point >= out_.mesh.n_nodes())
            in.fail("face " + std::to_string(f) + " names point " + std::to_string(point) + " of " +
                    std::to_string(out_.mesh.n_nodes()) + " (counted from 0)");
          node = static_cast<Index>(point);
        }
        in.expect(")");
      }
      in.expect(")");
    });
    const auto cells = [&](const char* name, std::vector<Index>& of_face) {
      in_file(file(name), [&](FoamCursor& in) {
        of_face.resize(in.list("faces"));
        if (of_face.size() > faces_.size())
          in.fail("there are " + std::to_string(of_face.size()) + " for " + std::to_string(faces_.size()) + " faces");
        for (Index& cell : of_face) {
          const std::int64_t number = in.integer("a cell");
          // A cell has six faces.
          if (number < -1 || number > static_cast<std::int64_t>(faces_.size()))
            in.fail("cell " + std::to_string(number) + " of at most " + std::to_string(faces_.size()));
          cell = static_cast<Index>(number);
          n_cells_ = std::max(n_cells_, cell + 1);
        }
        in.expect(")");
      });
    };
    cells("owner", owner_);
    cells("neighbour", neighbour_);
    if (owner_.size() != faces_.size())
      fail("owner has " + std::to_string(owner_.size()) + " cells for " + std::to_string(faces_.size()) + " faces");
  }

  /// Faces of a cell, and whether they turn out of it; n may be more.
  struct CellFaces {
    std::array<std::pair<Index, bool>, 6> faces{};
    std::size_t n = 0;
  };

  void cells() {
    if (n_cells_ == 0) fail("there is no hex in the file");
    std::vector<CellFaces> faces_of(static_cast<std::size_t>(n_cells_));
    const auto add = [&](Index cell, std::size_t face, bool turns_out) {
      CellFaces& own = faces_of[cell];
      if (own.n < own.faces.size()) own.faces[own.n] = {static_cast<Index>(face), turns_out};
      ++own.n;
    };
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (owner_[f] < 0) fail("face " + std::to_string(f) + " has no owner");
      add(owner_[f], f, true);
      if (f < neighbour_.size() && neighbour_[f] >= 0) add(neighbour_[f], f, false);
    }
    out_.mesh.hexes.resize(static_cast<std::size_t>(n_cells_));
    side_of_face_.assign(faces_.size(), {});
    side_of_neighbour_.assign(faces_.size(), {});
    for (Index c = 0; c < n_cells_; ++c) hex(c, faces_of[c]);
  }

  /// From six faces: the first, and along edges of four others to the one across.
  void hex(Index cell, const CellFaces& all) {
    const auto wrong = [&](const std::string& what) { fail("cell " + std::to_string(cell) + " " + what); };
    const auto& own = all.faces;
    if (all.n != own.size()) wrong("has " + std::to_string(all.n) + " faces; hexes have 6");
    Quad lower = faces_[own[0].first];
    // Counter-clockwise seen from inside: the order of the lower corners.
    if (own[0].second) std::swap(lower[1], lower[3]);
    Quad upper{-1, -1, -1, -1};
    for (int k = 0; k < 4; ++k) {
      // Of a face with this corner, the neighbour of the corner that is not in the lower face.
      for (std::size_t i = 1; i < 6; ++i) {
        const Quad& q = faces_[own[i].first];
        const auto at = std::ranges::find(q, lower[k]) - q.begin();
        if (at == 4) continue;
        for (const Index node : {q[(at + 1) % 4], q[(at + 3) % 4]})
          if (std::ranges::find(lower, node) == lower.end()) {
            if (upper[k] >= 0 && upper[k] != node) wrong("is no hex: its faces do not fit together");
            upper[k] = node;
          }
      }
      if (upper[k] < 0) wrong("is no hex: its faces do not fit together");
    }
    out_.mesh.hexes[cell] =
        in_file_order({lower[0], lower[1], lower[2], lower[3], upper[0], upper[1], upper[2], upper[3]});
    // All six have to be faces of what was found.
    for (const auto& [f, turns_out] : own) {
      bool found = false;
      for (int face = 0; face < n_hex_faces; ++face) {
        if (ascending(face_nodes(out_.mesh.hexes[cell], face)) != ascending(faces_[f])) continue;
        found = true;
        (turns_out ? side_of_face_ : side_of_neighbour_)[f] = {cell, face};
      }
      if (!found) wrong("is no hex: its faces do not fit together");
    }
  }

  void boundary() {
    in_file(file("boundary"), [&](FoamCursor& in) { patches(in); });
  }

  void patches(FoamCursor& in) {
    const std::size_t n = in.list("patches");
    for (std::size_t i = 0; i < n; ++i) {
      SideSet set{static_cast<int>(i) + 1, std::string(in.token()), {}};
      in.expect("{");
      std::int64_t first = -1, n_faces = -1;
      std::string kept;
      for (std::string_view word = in.token(); word != "}"; word = in.token()) {
        if (word.empty()) in.fail("the file ends inside of patch " + set.name);
        if (word == "nFaces") {
          n_faces = in.integer("a number of faces");
          in.expect(";");
        } else if (word == "startFace") {
          first = in.integer("a face");
          in.expect(";");
        } else {
          kept += std::string(word);
          for (word = in.token(); word != ";"; word = in.token()) {
            if (word.empty() || word == "}") in.fail("an entry of patch " + set.name + " has no end");
            kept += " " + std::string(word);
          }
          kept += ";";
        }
      }
      if (first < 0 || n_faces < 0 || n_faces > std::ssize(faces_) || first > std::ssize(faces_) - n_faces)
        fail("patch " + set.name + " has " + std::to_string(n_faces) + " faces from " + std::to_string(first) +
             " on, of " + std::to_string(faces_.size()));
      for (std::int64_t f = first; f < first + n_faces; ++f)
        set.sides.push_back(side_of_face_[static_cast<std::size_t>(f)]);
      sort_unique(set.sides);
      if (set.name == default_patch && kept == "type patch;") continue;
      entries_.push_back(kept);
      patch_numbers_.push_back(set.id);
      out_.mesh.side_sets.push_back(std::move(set));
    }
  }

  template <class Take>
  void zones(const char* name, std::string_view list, Take&& take) {
    std::error_code error;
    if (!std::filesystem::exists(folder_ / name, error)) return;
    in_file(folder_ / name, [&](FoamCursor& in) { zones_in(in, list, take); });
  }

  struct Zone {
    std::string name;
    std::vector<std::int64_t> labels, flips;
  };
  template <class Take>
  static void zones_in(FoamCursor& in, std::string_view list, Take&& take) {
    const std::size_t n = in.list("zones");
    for (std::size_t i = 0; i < n; ++i) {
      Zone zone{std::string(in.token()), {}, {}};
      in.expect("{");
      for (std::string_view word = in.token(); word != "}"; word = in.token()) {
        if (word.empty()) in.fail("the file ends inside of zone " + zone.name);
        if (word == list) {
          zone.labels = in.labels("a member");
          in.expect(";");
        } else if (word == "flipMap") {
          zone.flips = in.labels("a flip");
          in.expect(";");
        } else {
          for (word = in.token(); word != ";"; word = in.token())
            if (word.empty()) in.fail("the file ends inside of zone " + zone.name);
        }
      }
      take(zone);
    }
  }

  const std::filesystem::path folder_;
  const std::string name_;
  MeshFile out_;
  std::vector<Quad> faces_;
  std::vector<Index> owner_, neighbour_;
  std::vector<Side> side_of_face_, side_of_neighbour_;
  std::vector<std::string> entries_;  // of patches that are side sets
  std::vector<int> patch_numbers_;    // per side set; -1: a zone
  Index n_cells_ = 0;
};

}  // namespace

std::filesystem::path poly_mesh_of(const std::filesystem::path& file) {
  return file.parent_path() / "constant" / "polyMesh";
}

MeshFile read_openfoam(const std::filesystem::path& file, const Fence&) {
  return FoamReader(file).result();
}

}  // namespace hextwist::io
