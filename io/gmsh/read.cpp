// Gmsh's .msh: the sections in turn (Gmsh reference manual, "MSH file format", versions 1, 2.2 and 4.1).
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/gmsh/others.h"
#include "hextwist/io/gmsh/slice_internal.h"

namespace hextwist::io {
namespace {

/// Skips an unknown section.
void skip_section(Cursor& cursor, std::string_view name, const char* start) {
  const std::string mark = "$End" + std::string(name);
  const std::string_view rest(cursor.at, cursor.left());
  const auto at = rest.find(mark);
  if (at == std::string_view::npos) cursor.fail_at(start, "the file ends before " + mark);
  cursor.at += at;
}

void read_format(GmshContents& contents, Cursor& cursor) {
  const char* start = cursor.at;
  const std::string_view version = cursor.word();
  const int type = cursor.small("the file type");
  const int size = cursor.small("the data size");
  cursor.line();
  if (version == "4.1")
    contents.version = 41;
  else if (version == "2" || version == "2.0" || version == "2.1" || version == "2.2")
    contents.version = 22;
  else
    cursor.fail_at(start, "version " + shown(version) + " of Gmsh's format is not known here, 1, 2.2 and 4.1 are");
  if (type != 0 && type != 1) cursor.fail_at(start, "file type " + std::to_string(type) + " is neither 0 nor 1");
  if (type == 1 && size != 8) cursor.fail_at(start, "data size " + std::to_string(size) + " instead of 8");
  if (type == 0) return;
  cursor.binary = true;
  const auto one = cursor.raw<std::int32_t>("the number one");
  if (one == 1) return;
  cursor.swapped = true;
  if (one != 0x01000000) cursor.fail("the number one is " + std::to_string(one) + ": not a binary Gmsh file");
}

/// A line with a name in quotes.
std::string quoted_name(Cursor& cursor) {
  std::string_view name = trimmed(cursor.line());
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return std::string(name);
}

void read_names(GmshContents& contents, Cursor& cursor) {
  const auto n = cursor.check_count(cursor.integer("the number of physical names"), 5, "physical names");
  for (std::size_t i = 0; i < n; ++i) {
    cursor.skip_blanks();
    const char* start = cursor.at;
    const int dim = cursor.small("a dimension"), id = cursor.small("a physical tag");
    if (dim < 0 || dim > 3) cursor.fail_at(start, "dimension " + std::to_string(dim) + " of a physical group");
    contents.physical_names[{dim, id}] = quoted_name(cursor);
  }
}

/// Of values that nothing here has a place for.
void read_name_of_corners(GmshContents& contents, Cursor& cursor) {
  const char* start = cursor.at;
  const std::int64_t n_names = cursor.integer("the number of names");
  cursor.line();
  std::string name = n_names > 0 ? quoted_name(cursor) : "";
  if (std::ranges::find(contents.of_corners, name) == contents.of_corners.end())
    contents.of_corners.push_back(std::move(name));
  skip_section(cursor, "ElementNodeData", start);
}

/// The section of a name; false if there is no such section.
bool read_section(GmshContents& contents, Cursor& cursor, std::string_view name) {
  GmshSource source{cursor};
  const bool v4 = contents.version == 41;
  if (name == "PhysicalNames")
    read_names(contents, cursor);
  else if (name == "Entities" && v4)
    read_gmsh_entities_4(contents, source, false);
  else if (name == "PartitionedEntities" && v4)
    read_gmsh_entities_4(contents, source, true);
  else if (name == "Nodes" || name == "NOD" || name == "ParametricNodes")
    v4 ? read_gmsh_nodes_4(contents, source) : read_gmsh_nodes_1(contents, source, name == "ParametricNodes");
  else if (name == "Elements")
    v4 ? read_gmsh_elements_4(contents, source) : read_gmsh_elements_2(contents, source);
  else if (name == "ELM")
    read_gmsh_elements_1(contents, source);
  else if (name == "NodeData")
    read_gmsh_data(contents, source, Field::On::node);
  else if (name == "ElementData")
    read_gmsh_data(contents, source, Field::On::hex);
  else if (name == "ElementNodeData")
    read_name_of_corners(contents, cursor);
  else if (name == "Periodic" && contents.version != 1)
    read_gmsh_periodic(contents, source);
  else if (name == "HextwistParts")
    read_gmsh_parts(contents, cursor);
  else
    return false;
  return true;
}

/// The name of the section that begins here, of which the cursor has passed the first line; empty: there is none.
std::string_view begin_section(Cursor& cursor) {
  return cursor.more() && *cursor.at == '$' ? trimmed(cursor.line()).substr(1) : std::string_view();
}

}  // namespace

GmshPartition gmsh_partition(const Bytes& bytes) {
  Cursor cursor(bytes);
  GmshContents contents;
  for (;;) {
    const char* start = cursor.at;
    const std::string_view name = begin_section(cursor);
    if (name == "MeshFormat")
      read_format(contents, cursor);
    else if (name.empty() || contents.version != 41 || name == "Nodes" || name == "Elements")
      return {};
    else if (name == "PartitionedEntities")
      break;
    else
      skip_section(cursor, name, start);
    cursor.skip_blanks();
    cursor.line();  // "$End..."
  }
  GmshSource source{cursor};
  read_gmsh_entities_4(contents, source, true);
  return {contents.n_partitions, std::move(contents.partitions)};
}

const GmshType* gmsh_type(int type) {
  static constexpr std::array<GmshType, 32> types = {{
      {-1, 0, ""},
      {1, 2, "line"},
      {2, 3, "triangle"},
      {2, 4, "quad"},
      {3, 4, "tetrahedron"},
      {3, 8, "hex"},
      {3, 6, "wedge"},
      {3, 5, "pyramid"},
      {1, 3, "3-node line"},
      {2, 6, "6-node triangle"},
      {2, 9, "9-node quad"},
      {3, 10, "10-node tetrahedron"},
      {3, 27, "27-node hex"},
      {3, 18, "18-node wedge"},
      {3, 14, "14-node pyramid"},
      {0, 1, "point"},
      {2, 8, "8-node quad"},
      {3, 20, "20-node hex"},
      {3, 15, "15-node wedge"},
      {3, 13, "13-node pyramid"},
      {2, 9, "9-node triangle"},
      {2, 10, "10-node triangle"},
      {2, 12, "12-node triangle"},
      {2, 15, "15-node triangle"},
      {2, 15, "15-node triangle"},
      {2, 21, "21-node triangle"},
      {1, 4, "4-node line"},
      {1, 5, "5-node line"},
      {1, 6, "6-node line"},
      {3, 20, "20-node tetrahedron"},
      {3, 35, "35-node tetrahedron"},
      {3, 56, "56-node tetrahedron"},
  }};
  return type >= 1 && type < static_cast<int>(types.size()) ? &types[type] : nullptr;
}

int check_gmsh_type(GmshContents& contents, const Cursor& cursor, const char* at, int type, std::int64_t tag,
                    std::int64_t count) {
  const GmshType* known = gmsh_type(type);
  if (!known)
    cursor.fail_at(at, "element " + std::to_string(tag) + " has type " + std::to_string(type) +
                           ", which is not a hex, quad, line or point");
  if (contents.slice && type != gmsh_kept[known->dim])
    contents.slice->refuse(
        "elements other than hexes of 8 nodes, quads, lines and points (element " + std::to_string(tag) + ")", false);
  if (type == gmsh_kept[known->dim] || std::ranges::find(gmsh_second_order, type) != gmsh_second_order.end())
    return known->dim;
  contents.last_type = type;
  if (is_gmsh_other(type)) return gmsh_beside;
  if (known->dim == 3)
    cursor.fail_at(at,
                   "element " + std::to_string(tag) + " is a " + known->name +
                       "; hexes of 8, 20 or 27 nodes and, beside them, solids of at most second order are accepted");
  contents.n_dropped[known->name] += count;
  return -1;
}

void add_gmsh_element(GmshContents& contents, const Cursor& cursor, int dim, std::int64_t tag,
                      std::span<const std::int64_t> node_ids, const char* at) {
  const auto node = [&](std::int64_t id) {
    const Index index = contents.nodes.find(id);
    if (index < 0)
      cursor.fail_at(at,
                     "element " + std::to_string(tag) + " names node " + std::to_string(id) + ", which is not there");
    return index;
  };
  contents.elements[dim].tags.push_back(tag);
  if (dim == 3) {
    Hex hex;
    for (int c = 0; c < 8; ++c) hex[c] = node(node_ids[c]);
    contents.hexes.push_back(in_file_order(hex));
    if (node_ids.size() == 8) return;
    std::array<Index, 19> middles;
    for (std::size_t i = 8; i < node_ids.size(); ++i) middles[i - 8] = node(node_ids[i]);
    contents.middles.add(contents.hexes.size() - 1, std::span(middles).first(node_ids.size() - 8), gmsh_middles);
  } else if (dim == gmsh_beside) {
    contents.other_types.push_back(contents.last_type);
    for (const std::int64_t id : node_ids) contents.elements[dim].nodes.push_back(node(id));
    contents.other_first.push_back(static_cast<Index>(contents.elements[dim].nodes.size()));
  } else {
    for (const std::int64_t id : node_ids.first(static_cast<std::size_t>(gmsh_corners[dim])))
      contents.elements[dim].nodes.push_back(node(id));
    if (dim == 1 && node_ids.size() > 2) {
      contents.line_middles.resize(contents.elements[dim].tags.size(), -1);
      contents.line_middles.back() = node(node_ids[2]);
    }
  }
}

void read_gmsh_data(GmshContents& contents, GmshSource& source, Field::On on) {
  Cursor& cursor = source.cursor;
  GmshData data;
  data.field.on = on;
  const auto n_names = cursor.check_count(cursor.integer("the number of names"), 1, "names");
  cursor.line();
  for (std::size_t i = 0; i < n_names; ++i) {
    std::string name = quoted_name(cursor);
    if (i == 0) data.field.name = std::move(name);
  }
  const auto n_reals = cursor.check_count(cursor.integer("the number of real tags"), 1, "real tags");
  for (std::size_t i = 0; i < n_reals; ++i) {
    const double value = cursor.real("a real tag");
    if (i == 0) data.time = value;
  }
  const auto n_integers = cursor.check_count(cursor.integer("the number of integer tags"), 1, "integer tags");
  std::array<int, 3> integers = {0, 1, 0};
  for (std::size_t i = 0; i < n_integers; ++i) {
    const int value = cursor.small("an integer tag");
    if (i < 3) integers[i] = value;
  }
  cursor.line();
  data.step = integers[0];
  data.field.components = integers[1];
  if (integers[1] < 1 || integers[1] > 1000)
    cursor.fail("field " + shown(data.field.name) + " has " + std::to_string(integers[1]) + " components");
  const auto n = cursor.check_count(integers[2], 4, "values");
  if (cursor.binary) cursor.check_count(integers[2], 4 + 8 * static_cast<std::size_t>(integers[1]), "values");
  for (std::size_t i = 0; i < n; ++i) {
    data.tags.push_back(source.integer("a node or element"));
    for (int c = 0; c < integers[1]; ++c) data.field.values.push_back(source.real("a value"));
    if (!contents.slice || keeps_of_slice(contents, on, data.tags.back())) continue;
    data.tags.pop_back();
    data.field.values.resize(data.field.values.size() - static_cast<std::size_t>(integers[1]));
  }
  if (contents.slice && n == 0) contents.slice->refuse("a field without values", true);  // a field of nothing
  contents.data.push_back(std::move(data));
}

void read_gmsh_parts(GmshContents& contents, Cursor& cursor) {
  const auto entity = [&] {
    const int dim = cursor.small("a dimension");
    return Owner{dim, cursor.small("a tag")};
  };
  const auto n_parts = cursor.check_count(cursor.integer("the number of parts"), 8, "parts");
  for (std::size_t i = 0; i < n_parts; ++i) {
    const Owner part = entity(), parent = entity();
    contents.parents[part] = parent.dim < 0 || parent.id <= 0 ? Owner{} : parent;
  }
  const auto n_groups = cursor.check_count(cursor.integer("the number of groups"), 6, "groups");
  for (std::size_t i = 0; i < n_groups; ++i) {
    auto& [group, tags] = contents.more_members.emplace_back(entity(), std::vector<std::int64_t>{});
    tags.resize(cursor.check_count(cursor.integer("the number of members"), 2, "members"));
    for (auto& tag : tags) tag = cursor.integer("an element");
  }
}

void read_gmsh_sections(GmshContents& contents, Cursor& cursor) {
  bool nodes = false, elements = false;
  // Sections that a file has once, with their text: views that Gmsh appends may have all of them again.
  std::map<std::string, std::string_view, std::less<>> seen;
  bool again = false;
  constexpr std::string_view once[] = {"PhysicalNames", "Entities", "PartitionedEntities", "Periodic", "HextwistParts",
                                       "Nodes",         "NOD",      "ParametricNodes",     "Elements", "ELM",
                                       "MeshFormat"};
  while (cursor.more()) {
    const char* start = cursor.at;
    if (*start != '$') {
      if (contents.version == 0) cursor.fail("not a Gmsh file: it does not begin with $MeshFormat");
      cursor.fail("expected a section ($...), found " + shown(cursor.word()));
    }
    const std::string_view name = trimmed(cursor.line()).substr(1);
    const std::string_view rest(cursor.at, cursor.left());
    const auto before = seen.find(name);
    const bool is_repeated = before != seen.end() && rest.starts_with(before->second);
    if (is_repeated && (again || (name == "MeshFormat" && nodes && elements))) {
      again = true;
      cursor.at += before->second.size();
    } else if (name == "MeshFormat") {
      if (contents.version) cursor.fail_at(start, "a second $MeshFormat");
      read_format(contents, cursor);
    } else {
      if (name == "NOD" && contents.version == 0) contents.version = 1;
      if (name == "Comments" || contents.version == 0) {
        if (name != "Comments") cursor.fail_at(start, "$" + std::string(name) + " before $MeshFormat");
        skip_section(cursor, name, start);
      } else {
        const bool is_nodes = name == "Nodes" || name == "NOD" || name == "ParametricNodes";
        const bool is_elements = name == "Elements" || name == "ELM";
        if ((is_nodes && nodes) || (is_elements && elements) || before != seen.end())
          cursor.fail_at(start, "a second $" + std::string(name));
        if (is_elements && !nodes) cursor.fail_at(start, "elements before nodes");
        if (!read_section(contents, cursor, name)) skip_section(cursor, name, start);
        nodes = nodes || is_nodes;
        elements = elements || is_elements;
      }
    }
    if (std::ranges::find(once, name) != std::end(once) && before == seen.end())
      seen.emplace(name, rest.substr(0, static_cast<std::size_t>(cursor.at - rest.data())));
    cursor.skip_blanks();
    const char* at = cursor.at;
    const std::string_view last = cursor.word();
    const std::string expected = (contents.version == 1 ? "$END" : "$End") + std::string(name);
    if (last != expected)
      cursor.fail_at(
          at, last.empty() ? "the file ends before " + expected : "expected " + expected + ", found " + shown(last));
  }
  if (!nodes || !elements)
    cursor.fail_at(cursor.end, std::string("the file ends without ") + (nodes ? "elements" : "nodes"));
}

MeshFile read_gmsh(const Bytes& bytes) {
  Cursor cursor(bytes);
  GmshContents contents;
  read_gmsh_sections(contents, cursor);
  return assemble_gmsh(std::move(contents), cursor);
}

}  // namespace hextwist::io
