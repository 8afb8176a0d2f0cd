// SPECFEM3D's mesh folder. All six files of sides are written, so that none of another mesh stays.
#include "hextwist/base/sorted.h"
#include "hextwist/io/group_names.h"
#include "hextwist/io/specfem/specfem_internal.h"

namespace hextwist::io {
namespace {

class SpecfemWriter {
 public:
  SpecfemWriter(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                std::vector<std::string>& notices)
      : file_(file), folder_(file.parent_path()), mesh_(mesh), options_(options), notices_(notices) {}

  void write() {
    say_no_fields(mesh_, "SPECFEM3D's mesh", notices_);
    if (!mesh_.node_ids.empty() || !mesh_.hex_ids.empty())
      notices_.emplace_back("SPECFEM3D counts nodes and elements from 1: so they are in the files");
    if (!mesh_.node_sets.empty())
      notices_.push_back(counted(std::ssize(mesh_.node_sets), "node set") + " left out: SPECFEM3D has none");
    std::error_code error;
    if (!folder_.empty()) std::filesystem::create_directories(folder_, error);
    if (error) throw Error(folder_.string() + ": cannot be made (" + error.message() + ")");
    if (std::filesystem::exists(folder_ / specfem_cpml, error))
      notices_.push_back(std::string(specfem_cpml) + " is there already and stays, though its elements may be others");
    nodes();
    hexes();
    materials();
    sides();
    open(file_);  // empty: the name of the folder's mesh
    // All are complete by now; what is left is to give them their names.
    for (const auto& out : outputs_) out->commit();
  }

 private:
  Output& open(const std::filesystem::path& path) {
    return *outputs_.emplace_back(std::make_unique<Output>(path, options_.overwrite));
  }

  void nodes() {
    Output& out = open(folder_ / "nodes_coords_file");
    out << mesh_.points.size() << '\n';
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const Vec3& p = mesh_.points[n];
      out << n + 1 << ' ' << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
  }

  void hexes() {
    Output& out = open(folder_ / "mesh_file");
    out << mesh_.hexes.size() << '\n';
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      out << h + 1;
      const FileHex hex = file_hex(mesh_, options_.second, h, specfem_middles);
      for (const Index n : hex.all()) out << ' ' << n + 1;
      out << '\n';
    }
  }

  /// What is known of a material by its block, "2 rho vp vs ..."; empty: nothing.
  std::string description(int block) const {
    if (!options_.extras) return "";
    const auto found = options_.extras->materials.find(block);
    return found == options_.extras->materials.end() ? "" : found->second;
  }

  void materials() {
    std::vector<int> block_of_hex = first_block_of_hexes(mesh_, "SPECFEM3D", notices_);
    const auto none = static_cast<int>(mesh_.blocks.size());
    bool some_in_none = false;
    for (int& block : block_of_hex)
      if (block < 0) {
        block = none;
        some_in_none = true;
      }
    Output& list = open(folder_ / "nummaterial_velocity_file");
    std::vector<int> number(mesh_.blocks.size() + 1, 0);
    std::vector<std::string> others;
    int n_defined = 0, n_tomographic = 0, n_unknown = 0;
    const auto put = [&](std::size_t b, std::string text, const std::string& mark) {
      std::string domain = text.substr(0, text.find(' '));
      std::string rest(trimmed(text.substr(std::min(domain.size(), text.size()))));
      const bool tomographic = !rest.empty() && std::isalpha(static_cast<unsigned char>(rest[0]));
      if (rest.empty()) {
        // A speed of shear waves that SPECFEM3D refuses, so that nobody computes with it.
        domain = "2";
        rest = "0 0 0 9999 9999 0";
        ++n_unknown;
      }
      number[b] = tomographic ? -++n_tomographic : ++n_defined;
      list << domain << ' ' << number[b] << ' ' << rest << mark << '\n';
    };
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b) {
      const Block& block = mesh_.blocks[b];
      put(b, description(block.id),
          " " + std::string(specfem_mark) + std::to_string(block.id) + " " + one_line(block.name));
      if (number[b] != block.id) others.push_back(std::to_string(number[b]) + " is block " + std::to_string(block.id));
    }
    if (some_in_none) {
      put(mesh_.blocks.size(), description(0), "");
      if (!mesh_.blocks.empty())
        notices_.push_back("hexes in no block are of material " + std::to_string(number.back()));
    }
    if (!others.empty()) notices_.push_back("materials are counted in SPECFEM3D: " + joined(others, ", "));
    if (n_unknown > 0)
      notices_.push_back("nummaterial_velocity_file has no properties of " + counted(n_unknown, "material") +
                         ": put density and speeds in place of the zeros");
    Output& out = open(folder_ / "materials_file");
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      out << h + 1 << ' ' << number[static_cast<std::size_t>(block_of_hex[h])] << '\n';
  }

  void sides() {
    std::vector<std::string> others;
    for (const SideSet& set : mesh_.side_sets)
      if (std::ranges::find(specfem_surfaces, set.name) == std::end(specfem_surfaces))
        others.push_back(std::to_string(set.id) + (set.name.empty() ? "" : " '" + set.name + "'"));
    if (!others.empty())
      notices_.push_back("side sets left out, because SPECFEM3D knows " + joined(specfem_surfaces, ", ") +
                         " only: " + joined(others, ", "));
    NewIds ids;
    for (int file = 0; file < std::ssize(specfem_surfaces); ++file) {
      const std::string name = specfem_surfaces[file];
      std::vector<Side> sides;
      std::vector<int> together;
      for (const SideSet& set : mesh_.side_sets)
        if (set.name == name) {
          sides.insert(sides.end(), set.sides.begin(), set.sides.end());
          together.push_back(set.id);
          ids.add("sideset", set.id, name, file + 1);
        }
      if (together.size() > 1)
        notices_.push_back("sidesets " + joined(together, ", ") + " are one in the file, which all are called " + name);
      sort_unique(sides);
      Output& out = open(folder_ / name);
      out << sides.size() << '\n';
      for (const Side& side : sides) {
        const Quad q = face_node_cycle(mesh_.hexes[side.hex], side.face);
        out << side.hex + 1;
        for (const Index n : q) out << ' ' << n + 1;
        if (const SecondOrder* const second = options_.second) {
          for (std::size_t c = 0; c < 4; ++c) out << ' ' << second->middle_between(q[c], q[(c + 1) % 4]) + 1;
          out << ' ' << second->middle_of(q) + 1;
        }
        out << '\n';
      }
    }
    ids.tell("SPECFEM3D", notices_);
  }

  const std::filesystem::path file_, folder_;
  const Mesh& mesh_;
  const WriteOptions& options_;
  std::vector<std::string>& notices_;
  std::vector<std::unique_ptr<Output>> outputs_;
};

}  // namespace

void write_specfem(const std::filesystem::path& file, const Mesh& mesh, const WriteOptions& options,
                   std::vector<std::string>& notices) {
  SpecfemWriter(file, mesh, options, notices).write();
}

}  // namespace hextwist::io
