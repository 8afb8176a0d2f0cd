#include "hextwist/parts/files.h"

#include <algorithm>
#include <charconv>

#include "hextwist/base/text.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/arrays.h"
#include "hextwist/mesh/others.h"
#include "hextwist/mesh/validate/validate.h"
#include "hextwist/parts/join.h"
#include "hextwist/parts/join_on_disk.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/parts/own_part.h"
#include "hextwist/parts/shared_values.h"
#include "hextwist/parts/split.h"

namespace hextwist {
namespace {

/// The number behind the last dot, -1 where there is none.
int number_behind_dot(const std::string& text, std::size_t& dot) {
  dot = text.rfind('.');
  if (dot == std::string::npos || dot + 1 == text.size()) return -1;
  int number = -1;
  const char *begin = text.data() + dot + 1, *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end && *begin != '-' ? number : -1;
}

void refuse_second_order(const MeshFile& file, const std::filesystem::path& path) {
  if (file.middles.empty()) return;
  throw Error(path.string() + ": hexes of " + std::to_string(file.middles.nodes_per_hex) +
              " nodes are not split or joined; write it with 'set order 1' first");
}

void refuse_others(const Mesh& mesh, const std::filesystem::path& path) {
  if (mesh.others) throw Error(path.string() + ": other elements are not done in parts: it has " + others_text(mesh));
}

/// What a file of Gmsh says itself must fit its name, which other meshes may have as well.
SplitName gmsh_split_name(const std::filesystem::path& part) {
  const std::string stem = part.stem().string();
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos || !std::filesystem::is_regular_file(part)) return {};
  GmshPartHead head;
  try {
    head = read_gmsh_part_head(part);
  } catch (const Error&) {
    return {};  // whoever reads all of it says what is wrong
  }
  if (head.number < 0 || stem.substr(at + 1) != std::to_string(head.number + 1)) return {};
  std::filesystem::path name = part;
  name.replace_filename(stem.substr(0, at) + part.extension().string());
  return {name, head.n_parts};
}

/// Whether the part has members of a group.
bool has_members(const Mesh& mesh, FileResults::Of of, int id) {
  const auto has = [&](const auto& groups) {
    return std::ranges::any_of(groups, [&](auto& group) { return group.id == id && !items_of(group).empty(); });
  };
  if (of == FileResults::Of::block) return has(mesh.blocks);
  return of == FileResults::Of::node_set ? has(mesh.node_sets) : has(mesh.side_sets);
}

/// What a part has to say to the whole. Of a group that has all its members in other parts that is neither factors nor
/// properties, which Exodus files do not have of empty groups.
std::shared_ptr<const FileResults> results_to_join(const Mesh& mesh, std::string& lost) {
  const std::shared_ptr<const FileResults> results = results_of_parts(*mesh.results, lost);
  if (!results) return nullptr;
  FileResults kept = *results;
  const auto leave_out = [&](std::vector<SetExtras>& sets, const char* kind) {
    for (const SetExtras& set : sets)
      lost += std::string(lost.empty() ? "" : ", ") + "distribution factors of " + kind + " " + std::to_string(set.id);
    sets.clear();
  };
  leave_out(kept.node_sets, "nodeset");
  leave_out(kept.side_sets, "sideset");
  for (FileResults::Property& property : kept.properties)
    std::erase_if(property.values, [&](const auto& value) { return !has_members(mesh, property.of, value.first); });
  return kept.empty() ? nullptr : std::make_shared<const FileResults>(std::move(kept));
}

/// Without nodes of no hex of its own: Gmsh's files have those of ghosts.
Mesh without_loose_nodes(Mesh mesh) {
  const MeshedModel part{std::move(mesh), nullptr, {}};
  return Splitting(part, std::vector<int>(part.mesh.hexes.size(), 0), 1).part(0).mesh;
}

}  // namespace

SplitName split_name(const std::filesystem::path& part) {
  if (is_gmsh_part(part)) return gmsh_split_name(part);
  std::string text = part.string();
  std::size_t dot = 0;
  const int number = number_behind_dot(text, dot);
  if (number < 0) return {};
  text.resize(dot);
  const int n_parts = number_behind_dot(text, dot);
  if (n_parts < 1 || number >= n_parts) return {};
  text.resize(dot);
  return {text, n_parts};
}

Mesh read_one_part(const SplitName& split, int p, PartHead& first, std::vector<std::string>& notices,
                   const Fence& fence, PartUse use) {
  const int n_parts = split.n_parts;
  const std::filesystem::path file = part_name(split.name, n_parts, p);
  if (!std::filesystem::exists(file))
    throw Error(file.string() + ": this part of " + std::to_string(n_parts) + " is missing");
  const PartHead head = read_part_head(file);
  if (head.n_parts == 0) throw Error(file.string() + ": does not say what it is a part of");
  if (head.n_parts != n_parts)
    throw Error(file.string() + ": is one of " + std::to_string(head.n_parts) + " parts, not of " +
                std::to_string(n_parts));
  if (is_gmsh_part(file))
    if (const int number = read_gmsh_part_head(file).number; number != p)
      throw Error(
          file.string() +
          (number < 0 ? std::string(": is no single partition") : ": is partition " + std::to_string(number + 1)) +
          " of " + std::to_string(n_parts) + ", by its name it would be " + std::to_string(p + 1));
  if (first.n_parts == 0) first = head;
  if (head != first)
    throw Error(file.string() + ": is part of a mesh of " + std::to_string(head.n_hexes) + " hexes and " +
                std::to_string(head.n_nodes) + " nodes, " + part_name(split.name, n_parts, 0).string() + " of one of " +
                std::to_string(first.n_hexes) + " and " + std::to_string(first.n_nodes));
  MeshFile read = read_mesh(file, is_gmsh_part(file) ? "gmsh" : "exodus", fence);
  refuse_second_order(read, file);
  refuse_others(read.mesh, file);
  if (use == PartUse::refine) refuse_more(read.mesh, &read.extras, file.string());
  const auto tell = [&](const std::string& line) {
    if (std::ranges::find(notices, line) == notices.end()) notices.push_back(line);
  };
  for (const auto& lines : {read.notices, left_out_of_parts(read.extras)})
    for (const std::string& line : lines) tell(line);
  if (!read.tags.empty()) tell(use == PartUse::refine ? without_owners : joined_without_owners);
  if (read.mesh.results) {
    std::string lost;
    read.mesh.results = results_to_join(read.mesh, lost);
    // Of the whole: parts that lose the same say so once.
    if (!lost.empty())
      tell(split.name.string() +
           (use == PartUse::refine ? ": parts are refined without " : ": parts are joined without ") + lost);
  }
  read.mesh.file_hexes.clear();
  return is_gmsh_part(file) ? without_loose_nodes(std::move(read.mesh)) : std::move(read.mesh);
}

MeshFile read_parts(const std::filesystem::path& any_part, const Fence& fence) {
  const SplitName split = split_name(any_part);
  if (split.n_parts == 0)
    throw Error(any_part.string() +
                ": parts are called name.e.8.0, name.e.8.1, ..., or name_1.msh, ... as Gmsh splits meshes");
  std::vector<MeshedModel> pieces;
  MeshFile result;
  PartHead head;
  for (int p = 0; p < split.n_parts; ++p)
    pieces.push_back({read_one_part(split, p, head, result.notices, fence), nullptr, {}});
  for (std::string& line : disagreement_lines(settle_values(pieces), split.name.string()))
    result.notices.push_back(std::move(line));
  result.mesh = join(pieces, [&](std::size_t p) {
                  return part_name(split.name, split.n_parts, static_cast<int>(p)).string();
                }).mesh;
  for (const MeshedModel& piece : pieces) join_results(result.mesh.results, piece.mesh.results);
  check_counts(split, head, result.mesh.n_nodes(), result.mesh.n_hexes());
  return result;
}

void check_counts(const SplitName& split, const PartHead& said, std::int64_t n_nodes, std::int64_t n_hexes) {
  if (said.n_hexes > 0 && (n_hexes != said.n_hexes || n_nodes != said.n_nodes))
    throw Error(split.name.string() + ": its parts have " + std::to_string(n_hexes) + " hexes and " +
                std::to_string(n_nodes) + " nodes together, and say " + std::to_string(said.n_hexes) + " and " +
                std::to_string(said.n_nodes));
}

void refuse_more(const Mesh& mesh, const FileExtras* extras, const std::string& name) {
  if (mesh.others) throw Error(name + ": other elements are not done in parts: it has " + others_text(mesh));
  if (!extras) return;
  for (const auto& [block, n] : extras->nodes_per_hex)
    if (n > 8)
      throw Error(name + ": hexes of " + std::to_string(n) +
                  " nodes are not done in parts; write it with 'set order 1' first");
  if (std::ranges::find(extras->periodic, 2, &PeriodicPairs::dim) != extras->periodic.end())
    throw Error(name + ": periodic surfaces are not kept alike in parts; run it with hextwist");
}

void check_part(const Mesh& mesh, const std::string& name) {
  Mesh turned;
  turned.points = mesh.points;
  turned.hexes = mesh.hexes;
  if (const OrientationRepair repair = repair_orientation(turned); !repair.notice.empty())
    throw Error(name + ": " + repair.notice + "; that is done by hextwist alone: run its 'import' and 'export' first");
  for (const Violation& violation : validate(mesh))
    if (!is_warning(violation.kind)) throw Error(name + ": " + violation.text);
}

void need_ids(Mesh& mesh) {
  if (mesh.node_ids.empty())
    for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.node_ids.push_back(n + 1);
  if (mesh.hex_ids.empty())
    for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.hex_ids.push_back(h + 1);
}

std::vector<std::string> split_file(const std::filesystem::path& mesh, const std::filesystem::path& name, int n_parts,
                                    PartitionBy by, const Fence& fence) {
  check_output_name(name);
  if (by != PartitionBy::scotch && split_name(mesh).n_parts == 0) {
    std::vector<std::string> lines;
    OnDiskOptions options;
    options.fence = fence;
    options.n_parts = n_parts;
    options.by = by;
    if (split_on_disk(mesh, name, options, [&](const std::string& line) { lines.push_back(line); })) return lines;
  }
  MeshFile file = split_name(mesh).n_parts ? read_parts(mesh, fence) : read_mesh(mesh, {}, fence);
  refuse_second_order(file, mesh);
  std::vector<std::string> notices = std::move(file.notices);
  if (!file.tags.empty()) notices.emplace_back(without_owners);
  for (std::string& line : left_out_of_parts(file.extras)) notices.push_back(std::move(line));
  const MeshedModel whole{std::move(file.mesh), nullptr, {}};
  const std::vector<int> part_of_hex = partition(whole.mesh, n_parts, by);
  const Splitting splitting(whole, part_of_hex, n_parts);
  if (splitting.n_loose_nodes())
    notices.push_back("left out " + counted(splitting.n_loose_nodes(), "node") + " of no hex");
  PartOutput files(name, n_parts);
  std::int64_t largest = 0, n_shared = 0;
  for (int p = 0; p < n_parts; ++p) {
    MeshPart split = splitting.part(p);
    const OwnPart part{std::move(split.mesh), {}, std::move(split.file), {}};
    files.write(part, notices);
    largest = std::max<std::int64_t>(largest, part.mesh.n_hexes());
    for (const auto& shared : part.file.sides) n_shared += std::ssize(shared.sides);
  }
  files.commit();
  notices.push_back(split_text(whole.mesh.n_hexes(), n_parts, largest, n_shared / 2));
  return notices;
}

std::string split_text(std::int64_t n_hexes, int n_parts, std::int64_t largest, std::int64_t n_shared_faces) {
  return std::to_string(n_hexes) + " hexes in " + counted(n_parts, "part") + " of at most " + std::to_string(largest) +
         ", " + counted(n_shared_faces, "face") + " between them";
}

std::string joined_text(std::int64_t n_hexes, std::int64_t n_nodes, int n_parts) {
  return std::to_string(n_hexes) + " hexes and " + std::to_string(n_nodes) + " nodes of " + counted(n_parts, "part");
}

std::vector<std::string> join_files(const std::filesystem::path& any_part, const std::filesystem::path& to,
                                    const Fence& fence) {
  const SplitName split = split_name(any_part);
  if (split.n_parts > 0)
    if (std::optional<std::vector<std::string>> notices = join_on_disk(split, to, fence)) return std::move(*notices);
  MeshFile file = read_parts(any_part, fence);
  std::vector<std::string> notices = std::move(file.notices);
  for (std::string& line : write_mesh(to, file.mesh, nullptr, {})) notices.push_back(std::move(line));
  notices.push_back(joined_text(file.mesh.n_hexes(), file.mesh.n_nodes(), split.n_parts));
  return notices;
}

}  // namespace hextwist
