// SPECFEM3D's mesh folder: nodes_coords_file, mesh_file, materials_file, nummaterial_velocity_file, and files of sides.
#include <limits>
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/io/specfem/specfem_internal.h"

namespace hextwist::io {
namespace {

bool file_is_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

template <class F>
void in_mesh_file(const std::filesystem::path& file, F&& f) {
  const Bytes bytes = read_bytes(file);
  unchanged_by(bytes, [&] {
    Cursor cursor(bytes);
    f(cursor);
    return 0;
  });
}

class SpecfemReader {
 public:
  explicit SpecfemReader(const std::filesystem::path& file) : folder_(file.parent_path()) {}

  MeshFile result() {
    in_mesh_file(folder_ / "nodes_coords_file", [&](Cursor& in) { nodes(in); });
    in_mesh_file(folder_ / "mesh_file", [&](Cursor& in) { hexes(in); });
    in_mesh_file(folder_ / "materials_file", [&](Cursor& in) { materials(in); });
    if (file_is_there(folder_ / "nummaterial_velocity_file"))
      in_mesh_file(folder_ / "nummaterial_velocity_file", [&](Cursor& in) { descriptions(in); });
    blocks();
    for (std::size_t i = 0; i < std::size(specfem_surfaces); ++i)
      if (file_is_there(folder_ / specfem_surfaces[i]))
        in_mesh_file(folder_ / specfem_surfaces[i], [&](Cursor& in) { sides(in, static_cast<int>(i)); });
    if (file_is_there(folder_ / specfem_cpml))
      out_.notices.emplace_back("absorbing_cpml_file left out: elements that absorb are named by number");
    if (found_.any()) {
      found_.finish(out_.mesh.hexes.size());
      take_middles(out_, found_);
    }
    return std::move(out_);
  }

 private:
  /// The number of an item, 1 .. n, each once.
  static std::size_t place(Cursor& in, std::vector<char>& seen, const char* what) {
    in.skip_blanks();
    const char* const at = in.at;
    const std::int64_t number = in.integer(what);
    if (number < 1 || number > std::ssize(seen))
      in.fail_at(at, std::string(what) + " " + std::to_string(number) + " is not between 1 and " +
                         std::to_string(seen.size()));
    char& known = seen[static_cast<std::size_t>(number - 1)];
    if (known) in.fail_at(at, std::string(what) + " " + std::to_string(number) + " occurs twice");
    known = 1;
    return static_cast<std::size_t>(number - 1);
  }
  static void end(Cursor& in, const char* what) {
    if (in.more()) in.fail("there is more than " + std::string(what));
  }

  void nodes(Cursor& in) {
    auto& points = out_.mesh.points;
    points.resize(in.check_count(in.integer("the number of nodes"), 8, "nodes"));
    std::vector<char> seen(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t n = place(in, seen, "node");
      for (double& x : points[n]) {
        const char* const at = in.at;
        x = in.real("a coordinate");
        if (!std::isfinite(x)) in.fail_at(at, "a coordinate of node " + std::to_string(n + 1) + " is not finite");
      }
    }
    end(in, "the nodes");
  }

  /// Numbers in the first line of elements, without that of the element.
  static std::size_t nodes_per_hex(Cursor in) {
    in.skip_blanks();
    Cursor line(in.line(), in.name);
    std::size_t n = 0;
    while (!line.word().empty()) ++n;
    return n - (n > 0);
  }

  void hexes(Cursor& in) {
    auto& mesh = out_.mesh;
    const std::int64_t n_elements = in.integer("the number of elements");
    const std::size_t width = nodes_per_hex(in);
    if (n_elements == 0) in.fail("there is no hex in the file");
    in.skip_blanks();
    if (width != 8 && width != 27)
      in.fail("an element of " + std::to_string(width) + " nodes; only hexes of 8 or 27 nodes are accepted");
    mesh.hexes.resize(in.check_count(n_elements, 2 * (width + 1) - 1, "elements"));
    std::vector<char> seen(mesh.hexes.size(), 0);
    std::array<std::int64_t, 8> corners{};
    std::array<Index, 19> middles{};
    for (std::size_t i = 0; i < mesh.hexes.size(); ++i) {
      in.skip_blanks();
      const char* const at = in.at;
      const std::size_t h = place(in, seen, "element");
      for (std::size_t k = 0; k < width; ++k) {
        const std::int64_t node = in.integer("a node");
        if (node < 1 || node > mesh.n_nodes())
          in.fail_at(
              at, "element " + std::to_string(h + 1) + " names node " + std::to_string(node) + ", which is not there");
        if (k < 8)
          mesh.hexes[h][file_corner[k]] = static_cast<Index>((corners[k] = node) - 1);
        else
          middles[k - 8] = static_cast<Index>(node - 1);
      }
      if (const char* type = degenerate_hex(corners))
        in.fail_at(at, "element " + std::to_string(h + 1) + " is a " + type +
                           "; only hexes of 8, 20 or 27 nodes are accepted");
      if (width > 8) found_.add(h, middles, specfem_middles);
    }
    end(in, "the elements");
  }

  void materials(Cursor& in) {
    material_.resize(out_.mesh.hexes.size());
    std::vector<char> seen(material_.size(), 0);
    for (std::size_t i = 0; i < material_.size(); ++i) {
      const std::size_t h = place(in, seen, "element");
      material_[h] = in.small("a material");
      if (material_[h] == std::numeric_limits<int>::min()) in.fail("a material without a number");
    }
    end(in, "the materials of all elements");
  }

  /// Lines "domain number properties"; comments begin with # or !.
  void descriptions(Cursor& in) {
    while (in.at < in.end) {
      const char* const at = in.at;
      const std::string_view text = trimmed(in.line());
      if (text.empty() || text[0] == '#' || text[0] == '!') continue;
      Cursor line(text.substr(0, text.find('!')), in.name);
      const std::string domain(line.word());
      std::int64_t number = 0;
      if (!integer_in_field(line.word(), number) || number == 0 || std::abs(number) > std::numeric_limits<int>::max())
        in.fail_at(at, "expected a domain, the number of a material and its properties, found " + shown(text));
      Description& description = descriptions_[static_cast<int>(number)];
      description.text = domain + " " + std::string(trimmed({line.at, line.left()}));
      const auto mark = text.find(specfem_mark);
      if (mark == std::string_view::npos) continue;
      const std::string_view own = text.substr(mark + specfem_mark.size());
      const auto [stop, error] = std::from_chars(own.data(), own.data() + own.size(), description.block);
      if (error != std::errc{} || description.block < 0)
        in.fail_at(at, "a block without an id between 0 and 2147483647");
      description.name = std::string(trimmed({stop, own.data() + own.size()}));
    }
  }

  void blocks() {
    auto& blocks = out_.mesh.blocks;
    std::map<int, std::vector<Index>> of_material;
    for (std::size_t h = 0; h < material_.size(); ++h)
      if (material_[h] != 0) of_material[material_[h]].push_back(static_cast<Index>(h));
    // Those with an id of their own first, then the positive ones.
    for (const int pass : {0, 1, 2})
      for (auto& [material, hexes] : of_material) {
        const auto found = descriptions_.find(material);
        const Description* const own = found == descriptions_.end() ? nullptr : &found->second;
        const int wanted = own && own->block >= 0 ? own->block : std::max(material, 0);
        if (pass != (own && own->block >= 0 ? 0 : material > 0 ? 1 : 2)) continue;
        const bool is_free = (wanted > 0 || pass == 0) && position_in(blocks, wanted, &Block::id) < 0;
        Block& block = group_of_id(blocks, is_free ? wanted : free_id(blocks));
        if (own) {
          block.name = own->name;
          out_.extras.materials[block.id] = own->text;
        }
        block.hexes = std::move(hexes);
      }
  }

  void sides(Cursor& in, int file) {
    const std::size_t width = found_.any() ? 9 : 4;
    const std::size_t n = in.check_count(in.integer("the number of sides"), 2 * (width + 1) - 1, "sides");
    SideSet set{file + 1, specfem_surfaces[file], {}};
    for (std::size_t i = 0; i < n; ++i) {
      in.skip_blanks();
      const char* const at = in.at;
      const std::int64_t element = in.integer("an element");
      std::array<std::int64_t, 9> nodes{};
      for (std::size_t k = 0; k < width; ++k) nodes[k] = in.integer("a node");
      if (element < 1 || element > out_.mesh.n_hexes())
        in.fail_at(at, "element " + std::to_string(element) + " is not there");
      const auto h = static_cast<Index>(element - 1);
      std::ranges::sort(std::span(nodes).first(4));
      int side = -1;
      for (int f = 0; f < n_hex_faces; ++f) {
        const Quad q = ascending(face_nodes(out_.mesh.hexes[h], f));
        if (std::ranges::equal(q, std::span(nodes).first(4), {}, [](Index node) { return std::int64_t{node} + 1; }))
          side = f;
      }
      if (side < 0) in.fail_at(at, "these are no corners of a side of element " + std::to_string(element));
      set.sides.push_back({h, side});
    }
    end(in, "the sides");
    sort_unique(set.sides);
    out_.mesh.side_sets.push_back(std::move(set));
    std::ranges::sort(out_.mesh.side_sets, {}, &SideSet::id);
  }

  struct Description {
    std::string text;
    int block = -1;
    std::string name;
  };

  const std::filesystem::path folder_;
  MeshFile out_;
  FoundMiddles found_;
  std::vector<int> material_;
  std::map<int, Description> descriptions_;
};

}  // namespace

MeshFile read_specfem(const std::filesystem::path& file, const Fence&) {
  return SpecfemReader(file).result();
}

}  // namespace hextwist::io
