// Nodes, elements and entities of Gmsh's formats 1, 2.2 and 4.1.
#include <limits>
#include <utility>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/gmsh/gmsh.h"
#include "hextwist/io/gmsh/slice_internal.h"

namespace hextwist::io {
namespace {

/// Physical groups of reversed orientation have negative tags.
int positive(int physical) {
  return physical == std::numeric_limits<int>::min() ? 0 : std::abs(physical);
}

}  // namespace

void read_gmsh_nodes_1(GmshContents& contents, GmshSource& source, bool parametric) {
  Cursor& cursor = source.cursor;
  const std::int64_t count = cursor.integer("the number of nodes");
  cursor.line();
  const auto n = cursor.check_count(count, cursor.binary ? 28 : 8, "nodes");
  if (contents.slice) contents.slice->n_nodes = static_cast<std::int64_t>(n);
  std::vector<std::int64_t> ids;
  std::vector<Run> runs;
  if (!contents.slice) {
    ids.reserve(n);
    reserve_large(contents.points, n);
  }
  bool was_kept = false;
  for (std::size_t i = 0; i < n; ++i) {
    cursor.skip_text_blanks();
    const char* at = cursor.at;
    const std::int64_t id = source.integer("a node id");
    Vec3 point;
    source.coordinates(std::span(point.data(), 3));
    if (parametric) {  // skips the entity and its parameters: owners are better known from the elements
      const int dim = source.integer("a dimension");
      source.integer("an entity");
      for (int k = 0; k < dim && dim < 3; ++k) source.real("a parameter");
    }
    const bool is_kept = !contents.slice || keeps_node_of_slice(*contents.slice, id);
    if (is_kept) {
      if (!was_kept) runs.push_back({ids.size(), at});
      ids.push_back(id);
      contents.points.push_back(point);
    }
    was_kept = is_kept;
  }
  if (contents.slice && contents.slice->walk != GmshSlice::Walk::all) return;
  contents.nodes = Ids(std::move(ids), "node", cursor, parametric ? std::span<const Run>{} : runs);
  contents.nodes.sort(contents.points);
}

namespace {

void begin_run(GmshElements& elements, const char* at) {
  elements.runs.push_back({elements.tags.size(), at});
}

/// Tag, entity, physical group and nodes of an element of the versions 1 and 2.
void add_element(GmshContents& contents, GmshSource& source, int dim, int type, int tag, int physical, int entity,
                 const char* at) {
  std::array<std::int64_t, 27> ids;
  const auto nodes = std::span(ids).first(static_cast<std::size_t>(gmsh_type(type)->n_nodes));
  for (std::int64_t& id : nodes) id = source.integer("a node");
  physical = positive(physical);
  entity = std::max(entity, 0);
  if (contents.slice) return add_sliced_gmsh_element(contents, source.cursor, {dim, entity}, physical, tag, nodes, at);
  GmshElements& elements = contents.elements[dim];
  begin_run(elements, at);
  elements.physical.push_back(physical);
  elements.entity.push_back(entity);
  add_gmsh_element(contents, source.cursor, dim, tag, nodes, at);
}

}  // namespace

void read_gmsh_elements_1(GmshContents& contents, GmshSource& source) {
  Cursor& cursor = source.cursor;
  const auto n = cursor.check_count(cursor.integer("the number of elements"), 12, "elements");
  for (std::size_t i = 0; i < n; ++i) {
    cursor.skip_blanks();
    const char* at = cursor.at;
    const int tag = cursor.small("an element"), type = cursor.small("an element type");
    const int physical = cursor.small("a physical group"), entity = cursor.small("an entity");
    const int n_nodes = cursor.small("the number of nodes");
    const int dim = check_gmsh_type(contents, cursor, at, type, tag, 1);
    if (n_nodes != gmsh_type(type)->n_nodes)
      cursor.fail_at(at, "element " + std::to_string(tag) + " has " + std::to_string(n_nodes) + " nodes, a " +
                             gmsh_type(type)->name + " has " + std::to_string(gmsh_type(type)->n_nodes));
    if (dim >= 0)
      add_element(contents, source, dim, type, tag, physical, entity, at);
    else
      for (int k = 0; k < n_nodes; ++k) cursor.integer("a node");
  }
}

void read_gmsh_elements_2(GmshContents& contents, GmshSource& source) {
  Cursor& cursor = source.cursor;
  const std::int64_t count = cursor.integer("the number of elements");
  cursor.line();
  const auto n = cursor.check_count(count, 8, "elements");
  for (std::size_t done = 0; done < n;) {
    cursor.skip_text_blanks();
    const char* at = cursor.at;
    // Text: tag, type, number of tags, tags, nodes. Binary: the same, with type and number of tags up front for many.
    int tag = 0, follow = 1;
    if (!cursor.binary) tag = cursor.small("an element");
    const int type = source.integer("an element type");
    if (cursor.binary) follow = source.integer("the number of elements of a type");
    const int n_tags = source.integer("the number of tags");
    if (follow < 1 || static_cast<std::size_t>(follow) > n - done || n_tags < 0)
      cursor.fail_at(at, "a broken element header");
    cursor.check_count(n_tags, 2, "tags");
    for (int k = 0; k < follow; ++k) {
      if (cursor.binary) {
        at = cursor.at;
        tag = source.integer("an element");
      }
      int physical = 0, entity = 0;
      for (int t = 0; t < n_tags; ++t) {
        const int value = source.integer("a tag");
        if (t == 0) physical = value;
        if (t == 1) entity = value;
      }
      const int dim = check_gmsh_type(contents, cursor, at, type, tag, 1);
      if (dim >= 0)
        add_element(contents, source, dim, type, tag, physical, entity, at);
      else
        for (int c = 0; c < gmsh_type(type)->n_nodes; ++c) source.integer("a node");
    }
    done += static_cast<std::size_t>(follow);
  }
}

void read_gmsh_entities_4(GmshContents& contents, GmshSource& source, bool partitioned) {
  Cursor& cursor = source.cursor;
  const auto list = [&](std::string_view what, auto&& each) {
    const auto n = cursor.check_count(source.large(what), cursor.binary ? 4 : 2, what);
    for (std::size_t i = 0; i < n; ++i) each(source.integer(what));
  };
  const auto nothing = [](int) {};
  if (partitioned) {
    contents.n_partitions = static_cast<int>(
        std::clamp<std::int64_t>(source.large("the number of partitions"), 0, std::numeric_limits<int>::max()));
    const auto n_ghosts = cursor.check_count(source.large("the number of ghost entities"), 4, "ghost entities");
    for (std::size_t i = 0; i < n_ghosts; ++i) {
      contents.ghosts.push_back(source.integer("a ghost entity"));
      source.integer("a partition");
    }
    sort_unique(contents.ghosts);
  }
  std::array<std::size_t, 4> n_entities;
  for (auto& n : n_entities)
    n = cursor.check_count(source.large("the number of entities"), cursor.binary ? 36 : 10, "entities");
  for (int dim = 0; dim < 4; ++dim)
    for (std::size_t i = 0; i < n_entities[dim]; ++i) {
      const Owner entity{dim, source.integer("an entity")};
      bool is_between = false;  // partitions
      if (partitioned) {
        const int parent_dim = source.integer("a parent's dimension");
        const int parent = source.integer("a parent");
        if (parent_dim >= 0 && parent > 0) contents.parents[entity] = {parent_dim, parent};
        is_between = parent_dim > dim;
        list("partitions", [&](int partition) {
          if (dim == 3) contents.partitions.push_back(partition);
        });
      }
      for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) source.real("a box");
      auto& physicals = contents.entity_physicals[entity];
      list("physical groups", [&](int tag) {
        if (is_between)
          contents.has_groups_between = true;
        else
          physicals.push_back(positive(tag));
      });
      if (dim > 0) list("bounding entities", nothing);
    }
  sort_unique(contents.partitions);
}

void for_each_gmsh_node_block(GmshSource& source, const std::function<void(std::size_t)>& begin,
                              const std::function<void(const GmshBlock&)>& use) {
  Cursor& cursor = source.cursor;
  const auto n_blocks = source.large("the number of node blocks");
  const auto n = cursor.check_count(source.large("the number of nodes"), cursor.binary ? 32 : 8, "nodes");
  source.large("the lowest node id");
  source.large("the highest node id");
  begin(n);
  std::size_t done = 0;
  cursor.check_count(n_blocks, cursor.binary ? 20 : 8, "node blocks");
  for (std::int64_t i = 0; i < n_blocks; ++i) {
    cursor.skip_text_blanks();
    GmshBlock block;
    block.at = cursor.at;
    block.dim = source.integer("a dimension");
    block.entity = source.integer("an entity");
    block.kind = source.integer("whether nodes have parameters");
    if (block.dim < 0 || block.dim > 3)
      cursor.fail_at(block.at, "nodes on an entity of dimension " + std::to_string(block.dim));
    block.size = cursor.check_count(source.large("the number of nodes"), cursor.binary ? 32 : 8, "nodes");
    if (block.size > n - done) cursor.fail_at(block.at, "more nodes than the header says");
    cursor.skip_text_blanks();
    use(block);
    done += block.size;
  }
  if (done != n) cursor.fail("the header says " + std::to_string(n) + " nodes, there are " + std::to_string(done));
}

void read_gmsh_nodes_4(GmshContents& contents, GmshSource& source) {
  if (contents.slice) return read_sliced_gmsh_nodes(contents, source);
  Cursor& cursor = source.cursor;
  std::vector<std::int64_t> ids;
  std::vector<Run> runs;
  std::size_t n = 0, done = 0;
  bool any_parametric = false;
  const auto begin = [&](std::size_t n_all) {
    n = n_all;
    resize_for_overwrite(ids, n);
    resize_for_overwrite(contents.points, n);
    reserve_large(contents.node_entity, n);
  };
  for_each_gmsh_node_block(source, begin, [&](const GmshBlock& block) {
    const auto [dim, entity, parametric, size, at] = block;
    runs.push_back({done, cursor.at});
    const auto block_ids = std::span(ids).subspan(done, size);
    const auto points = std::span(contents.points).subspan(done, size);
    source.large_ones(block_ids, "a node id");
    if (!parametric) {
      source.coordinates(coordinates(points));
    } else {
      any_parametric = any_parametric || dim == 1 || dim == 2;
      if (any_parametric) contents.node_parameters.resize(n);
      for (std::size_t i = 0; i < size; ++i) {
        source.coordinates(coordinates(points.subspan(i, 1)));
        std::array<double, 3> u{};
        for (int k = 0; k < dim; ++k) u[k] = source.real("a parameter");
        if (dim == 1 || dim == 2) contents.node_parameters[done + i].u = u[0];
        if (dim == 2) contents.node_parameters[done + i].v = u[1];
      }
    }
    contents.node_entity.insert(contents.node_entity.end(), size, entity > 0 ? Owner{dim, entity} : Owner{});
    done += size;
  });
  contents.nodes = Ids(std::move(ids), "node", cursor, runs);
  contents.nodes.sort(contents.points);
  contents.nodes.sort(contents.node_entity);
  if (any_parametric) contents.nodes.sort(contents.node_parameters);
}

void for_each_gmsh_element_block(GmshSource& source, const std::function<void(std::size_t)>& begin,
                                 const std::function<void(const GmshBlock&)>& use) {
  Cursor& cursor = source.cursor;
  const auto n_blocks = source.large("the number of element blocks");
  const auto n = cursor.check_count(source.large("the number of elements"), cursor.binary ? 16 : 4, "elements");
  source.large("the lowest element tag");
  source.large("the highest element tag");
  cursor.check_count(n_blocks, cursor.binary ? 20 : 8, "element blocks");
  begin(n);
  std::size_t done = 0;
  for (std::int64_t i = 0; i < n_blocks; ++i) {
    cursor.skip_text_blanks();
    GmshBlock block;
    block.at = cursor.at;
    block.dim = source.integer("a dimension");
    block.entity = source.integer("an entity");
    block.kind = source.integer("an element type");
    block.size = cursor.check_count(source.large("the number of elements"), cursor.binary ? 16 : 4, "elements");
    if (block.size > n - done) cursor.fail_at(block.at, "more elements than the header says");
    done += block.size;
    if (block.size == 0) continue;
    cursor.skip_text_blanks();
    use(block);
  }
  if (done != n) cursor.fail("the header says " + std::to_string(n) + " elements, there are " + std::to_string(done));
}

void read_gmsh_elements_4(GmshContents& contents, GmshSource& source) {
  if (contents.slice) return read_sliced_gmsh_elements(contents, source);
  Cursor& cursor = source.cursor;
  std::size_t left = 0;
  const auto begin = [&](std::size_t n) { left = n; };
  for_each_gmsh_element_block(source, begin, [&](const GmshBlock& block) {
    const auto [entity_dim, entity, type, size, header] = block;
    const char* first = cursor.at;
    const std::int64_t first_tag = source.large("an element");
    const bool is_ghost = entity_dim == 3 && std::ranges::binary_search(contents.ghosts, entity);
    int dim = check_gmsh_type(contents, cursor, first, type, first_tag, static_cast<std::int64_t>(size));
    if (is_ghost) {
      contents.n_ghosts += static_cast<std::int64_t>(size);
      dim = -1;
    }
    cursor.at = first;
    const int n_nodes = gmsh_type(type)->n_nodes;
    if (dim >= 0) {
      GmshElements& elements = contents.elements[dim];
      begin_run(elements, first);
      const std::size_t most = left + elements.tags.size();  // however many blocks follow
      reserve_large(elements.tags, most);
      reserve_large(elements.entity, most);
      if (dim == 3) reserve_large(contents.hexes, most);
      elements.entity.insert(elements.entity.end(), size, entity_dim == gmsh_type(type)->dim ? std::max(entity, 0) : 0);
    }
    left -= size;
    std::array<std::int64_t, most_gmsh_nodes> ids;
    const auto nodes = std::span(ids).first(static_cast<std::size_t>(n_nodes));
    for (std::size_t i = 0; i < size; ++i) {
      cursor.skip_text_blanks();
      const char* at = cursor.at;
      const auto tag = source.large("an element");
      source.large_ones(nodes, "a node");
      if (dim >= 0) add_gmsh_element(contents, cursor, dim, tag, nodes, at);
    }
  });
}

void read_gmsh_periodic(GmshContents& contents, GmshSource& source) {
  Cursor& cursor = source.cursor;
  const bool v4 = contents.version == 41;
  // Text in every file of version 2.2.
  const bool binary = std::exchange(cursor.binary, cursor.binary && v4);
  const auto large = [&](std::string_view what) { return source.large(what); };
  const auto n = cursor.check_count(v4 ? large("the number of periodic entities") : cursor.integer("a number"), 6,
                                    "periodic entities");
  for (std::size_t i = 0; i < n; ++i) {
    PeriodicPairs link;
    cursor.skip_text_blanks();
    const char* at = cursor.at;
    link.dim = source.integer("a dimension");
    if (link.dim < 0 || link.dim > 3) cursor.fail_at(at, "a periodic entity of dimension " + std::to_string(link.dim));
    link.entity = source.integer("an entity");
    link.of = source.integer("an entity");
    std::size_t n_affine = 0;
    if (v4) {
      n_affine = cursor.check_count(large("the number of affine values"), cursor.binary ? 8 : 2, "affine values");
    } else if (cursor.more() && *cursor.at == 'A') {
      cursor.word();
      n_affine = 16;
    }
    for (std::size_t k = 0; k < n_affine; ++k) link.affine.push_back(source.real("an affine value"));
    link.nodes.resize(cursor.check_count(v4 ? large("the number of pairs") : cursor.integer("the number of pairs"), 4,
                                         "pairs of nodes"));
    for (auto& pair : link.nodes)
      for (auto& node : pair) node = v4 ? large("a node") : cursor.integer("a node");
    contents.periodic.push_back(std::move(link));
  }
  cursor.binary = binary;
}

}  // namespace hextwist::io
