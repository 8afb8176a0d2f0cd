// OpenFOAM's polyMesh, text. Faces inside come first, by owner and then by neighbour, as the solvers want them; then
// those of each patch. A boundary face is in one patch: that of the first side set that has it.
#include <map>

#include "hextwist/io/group_names.h"
#include "hextwist/io/openfoam/openfoam_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::io {
namespace {

class OpenfoamWriter {
 public:
  OpenfoamWriter(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                 std::vector<std::string>& notices)
      : file_(file), folder_(poly_mesh_of(file)), mesh_(mesh), options_(options), notices_(notices) {}

  void write() {
    say_no_fields(mesh_, "OpenFOAM's mesh", notices_);
    if (!mesh_.node_ids.empty() || !mesh_.hex_ids.empty())
      notices_.emplace_back("OpenFOAM has no ids: points and cells are counted from 0 in the files");
    divide();
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw Error(folder_.string() + ": cannot be made (" + error.message() + ")");
    points(), faces(), boundary(), zones();
    tell_ids();
    open(file_);  // empty: ParaView's name for the case
    // All are complete by now; what is left is to give them their names.
    for (const auto& out : outputs_) out->commit();
  }

 private:
  Output& open(const std::filesystem::path& path) {
    return *outputs_.emplace_back(std::make_unique<Output>(path, options_.overwrite));
  }
  Output& open(const char* name, const char* kind, const std::string& note = "") {
    Output& out = open(folder_ / name);
    out << "FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       " << kind << ";\n";
    if (!note.empty()) out << "    note        \"" << note << "\";\n";
    out << "    location    \"constant/polyMesh\";\n    object      " << name << ";\n}\n\n";
    return out;
  }

  /// Names are words there, unique. What begins as a number does is read as one.
  std::string word(const char* kind, int id, const std::string& name) {
    constexpr std::size_t longest = 100;
    std::string plain = plain_name(name, longest);
    if (!plain.empty() && std::string_view("0123456789-.").find(plain[0]) != std::string_view::npos)
      plain.insert(0, "_");
    const std::string result = distinct_name(kind, id, name, plain, longest, words_[kind], notices_);
    groups_[kind].push_back({id, name, result});
    return result;
  }

  /// Patches, cells and points are numbered as they come, zones of faces after the patches.
  void tell_ids() {
    NewIds ids;
    for (const auto& [kind, groups] : groups_) {
      std::vector<std::string> names;
      std::vector<int> wishes;
      for (const GroupInFile& group : groups) {
        names.push_back(group.written);
        wishes.push_back(kind == "sideset" && names.size() > n_patches_of_sets_ ? -1 : static_cast<int>(names.size()));
      }
      const std::vector<int> when_read = ids_by_name(kind, names, wishes);
      for (std::size_t g = 0; g < groups.size(); ++g) ids.add(kind.c_str(), groups[g].id, groups[g].name, when_read[g]);
    }
    ids.tell("OpenFOAM", notices_);
  }

  void divide() {
    const Faces all = hextwist::faces(mesh_);
    std::vector<int> patch_of(all.nodes.size(), -1);
    std::vector<std::uint8_t> counted_in(all.nodes.size(), 0);
    std::int64_t n_twice = 0;
    std::vector<const SideSet*> inner;
    for (const SideSet& set : mesh_.side_sets) {
      std::int64_t n_inside = 0;
      for (const Side& side : set.sides) n_inside += all.sides[all.of_hex[side.hex][side.face]][1].hex >= 0;
      const bool zone = n_inside > 0;
      if (zone) {
        inner.push_back(&set);
        continue;
      }
      const std::string own_name = set.name.empty() ? "sideset_" + std::to_string(set.id) : set.name;
      FoamPatch patch{own_name, word("sideset", set.id, set.name), plain_patch, {}};
      if (options_.extras)
        if (const auto found = options_.extras->patches.find(set.id); found != options_.extras->patches.end())
          patch.entries = found->second;
      for (const Side& side : set.sides) {
        const Index f = all.of_hex[side.hex][side.face];
        if (patch_of[f] >= 0) {
          ++n_twice;
          continue;
        }
        patch_of[f] = static_cast<int>(patches_.size());
        patch.faces.push_back({face_node_cycle(mesh_.hexes[side.hex], side.face), side.hex, -1, side});
      }
      patches_.push_back(std::move(patch));
    }
    if (n_twice > 0)
      notices_.push_back("side sets overlap, and a face is in one patch only: " + counted(n_twice, "face") +
                         (n_twice == 1 ? " is" : " are") + " in the first of its sets");
    n_patches_of_sets_ = patches_.size();
    FoamPatch rest{default_patch, default_patch, plain_patch, {}};
    for (std::size_t f = 0; f < all.nodes.size(); ++f) {
      const auto& [first, second] = all.sides[f];
      const FoamFace face{face_node_cycle(mesh_.hexes[first.hex], first.face), first.hex, second.hex, first};
      if (second.hex >= 0)
        inside_.push_back(face);
      else if (patch_of[f] < 0)
        rest.faces.push_back(face);
    }
    if (!rest.faces.empty()) patches_.push_back(std::move(rest));
    std::ranges::sort(inside_, {}, [](const FoamFace& face) { return std::pair(face.owner, face.neighbour); });
    for (FoamPatch& patch : patches_) std::ranges::sort(patch.faces, {}, &FoamFace::side);
    order_cyclic_patches(mesh_, patches_, notices_);
    // Where each side is in the files, for zones.
    std::size_t number = 0;
    const auto count = [&](const FoamFace& face) {
      number_of_face_.emplace_back(all.of_hex[face.side.hex][face.side.face], static_cast<Index>(number++));
    };
    for (const FoamFace& face : inside_) count(face);
    for (const FoamPatch& patch : patches_)
      for (const FoamFace& face : patch.faces) count(face);
    std::ranges::sort(number_of_face_);
    for (const SideSet* set : inner) {
      Zone zone{word("sideset", set->id, set->name), {}, {}};
      std::int64_t n_both = 0;
      for (const Side& side : set->sides) {
        const Index f = all.of_hex[side.hex][side.face];
        if (all.sides[f][0] != side && std::ranges::binary_search(set->sides, all.sides[f][0])) {
          ++n_both;
          continue;
        }
        zone.members.push_back(std::ranges::lower_bound(number_of_face_, std::pair(f, Index{0}))->second);
        zone.flips.push_back(all.sides[f][0] != side);
      }
      if (n_both > 0)
        notices_.push_back("sideset " + std::to_string(set->id) + " has both sides of " + counted(n_both, "face") +
                           ", and a face zone has a face once: that of the lower cell is in the file");
      face_zones_.push_back(std::move(zone));
    }
  }

  void points() {
    Output& out = open("points", "vectorField");
    out << mesh_.points.size() << "\n(\n";
    for (const Vec3& p : mesh_.points) out << '(' << p.x() << ' ' << p.y() << ' ' << p.z() << ")\n";
    out << ")\n";
  }

  void faces() {
    std::size_t n = inside_.size();
    for (const FoamPatch& patch : patches_) n += patch.faces.size();
    const std::string note = "nPoints:" + std::to_string(mesh_.points.size()) +
                             "  nCells:" + std::to_string(mesh_.hexes.size()) + "  nFaces:" + std::to_string(n) +
                             "  nInternalFaces:" + std::to_string(inside_.size());
    Output& list = open("faces", "faceList");
    Output& owner = open("owner", "labelList", note);
    Output& neighbour = open("neighbour", "labelList", note);
    list << n << "\n(\n", owner << n << "\n(\n", neighbour << inside_.size() << "\n(\n";
    const auto put = [&](const FoamFace& face) {
      const Quad& q = face.cycle;
      list << "4(" << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3] << ")\n";
      owner << face.owner << '\n';
      if (face.neighbour >= 0) neighbour << face.neighbour << '\n';
    };
    for (const FoamFace& face : inside_) put(face);
    for (const FoamPatch& patch : patches_)
      for (const FoamFace& face : patch.faces) put(face);
    list << ")\n", owner << ")\n", neighbour << ")\n";
  }

  void boundary() {
    Output& out = open("boundary", "polyBoundaryMesh");
    out << patches_.size() << "\n(\n";
    std::size_t first = inside_.size();
    for (const FoamPatch& patch : patches_) {
      out << "    " << patch.name << "\n    {\n";
      std::string_view rest = patch.entries;
      while (!rest.empty()) {
        const auto end = std::min(rest.find(';') + 1, rest.size());
        out << "        " << trimmed(rest.substr(0, end)) << '\n';
        rest.remove_prefix(end);
      }
      out << "        nFaces          " << patch.faces.size() << ";\n        startFace       " << first << ";\n    }\n";
      first += patch.faces.size();
    }
    out << ")\n";
  }

  struct Zone {
    std::string name;
    std::vector<Index> members;
    std::vector<bool> flips;
  };
  void write_zones(const char* file, const char* kind, const char* list, const std::vector<Zone>& zones) {
    Output& out = open(file, "regIOobject");
    out << zones.size() << "\n(\n";
    for (const Zone& zone : zones) {
      out << zone.name << "\n{\n    type " << kind << ";\n    " << list << " List<label> " << zone.members.size()
          << "\n(\n";
      for (const Index member : zone.members) out << member << '\n';
      out << ");\n";
      if (std::string_view(kind) == "faceZone") {
        out << "    flipMap List<bool> " << zone.flips.size() << "\n(\n";
        for (const bool flip : zone.flips) out << (flip ? "1\n" : "0\n");
        out << ");\n";
      }
      out << "}\n";
    }
    out << ")\n";
  }

  void zones() {
    const std::vector<int> block_of_hex = first_block_of_hexes(mesh_, "OpenFOAM", notices_);
    std::vector<Zone> cells, points;
    for (const Block& block : mesh_.blocks) cells.push_back({word("block", block.id, block.name), {}, {}});
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (block_of_hex[h] >= 0) cells[static_cast<std::size_t>(block_of_hex[h])].members.push_back(h);
    for (const NodeSet& set : mesh_.node_sets) points.push_back({word("nodeset", set.id, set.name), set.nodes, {}});
    write_zones("cellZones", "cellZone", "cellLabels", cells);
    write_zones("faceZones", "faceZone", "faceLabels", face_zones_);
    write_zones("pointZones", "pointZone", "pointLabels", points);
  }

  const std::filesystem::path file_, folder_;
  const Mesh& mesh_;
  const WriteOptions& options_;
  std::vector<std::string>& notices_;
  std::vector<FoamFace> inside_;
  std::vector<FoamPatch> patches_;
  std::vector<Zone> face_zones_;
  std::vector<std::pair<Index, Index>> number_of_face_;
  struct GroupInFile {
    int id;
    std::string name, written;
  };
  std::map<std::string, std::vector<GroupInFile>> groups_;  // by kind, in the order of the files
  std::map<std::string, std::set<std::string>> words_ = {{"sideset", {default_patch}}};
  std::size_t n_patches_of_sets_ = 0;
  std::vector<std::unique_ptr<Output>> outputs_;
};

}  // namespace

void write_openfoam(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                    std::vector<std::string>& notices) {
  OpenfoamWriter(file, mesh, options, notices).write();
}

}  // namespace hextwist::io
