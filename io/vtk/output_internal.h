// The arrays of a mesh as VTK's files and XDMF have them, whatever they are written by.
//
// Arrays, the template argument, has add<T>(name, span, components, more) of numbers as they lie in memory and
// add_each(name, n, components, value, more) of those that are made when they are written: value(0) .. value(n - 1), a
// number or a std::array of them each. `more`: attributes, for XML. What they are made of may be read until all is
// written.
#pragma once

#include "hextwist/io/middles.h"
#include "hextwist/io/vtk/other_cells_internal.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"

namespace hextwist::io {

/// Numbers of one value of an array: itself, or those of a std::array.
template <class T>
struct VtkNumbers {
  using Type = T;
  static std::span<const T> of(const T& value) { return {&value, 1}; }
};
template <class T, std::size_t n>
struct VtkNumbers<std::array<T, n>> {
  using Type = T;
  static std::span<const T> of(const std::array<T, n>& value) { return value; }
};

template <class T, std::size_t n>
std::array<T, n> cell_nodes(const Mesh& mesh, const SecondOrder* second, std::size_t hex) {
  const FileHex nodes = file_hex(mesh, second, static_cast<Index>(hex), vtk_middles);
  std::array<T, n> result;
  std::ranges::copy_n(nodes.nodes.begin(), n, result.begin());
  return result;
}

/// What VTK has no place for.
template <class Arrays>
void add_field_data(Arrays& arrays, const std::string& made_names, const Mesh& mesh, const Association& association) {
  const auto name = [](const char* kind, const auto& group) {
    return "hextwist:" + std::string(kind) + " " + std::to_string(group.id) + " " + group.name;
  };
  arrays.add_each(
      "hextwist:made" + made_names, 1, 1, [](std::size_t) { return std::int32_t{1}; }, tuples(1));
  for (const Block& block : mesh.blocks)
    arrays.template add<Index>(name("block", block), block.hexes, 1, tuples(block.hexes.size()));
  for (const NodeSet& set : mesh.node_sets)
    arrays.template add<Index>(name("nodeset", set), set.nodes, 1, tuples(set.nodes.size()));
  for (const SideSet& set : mesh.side_sets)
    arrays.add_each(
        name("sideset", set), set.sides.size(), 2,
        [&](std::size_t i) {
          return std::array{set.sides[i].hex, set.sides[i].face};
        },
        tuples(set.sides.size()));
  if (const auto& edges = association.curve_edges; !edges.empty())
    arrays.add_each(
        "hextwist:curve_edges", edges.size(), 3,
        [&](std::size_t i) {
          return std::array{edges[i][0], edges[i][1], association.edge_curve[i]};
        },
        tuples(edges.size()));
  if (const auto& faces = association.surface_faces; !faces.empty())
    arrays.add_each(
        "hextwist:surface_faces", faces.size(), 3,
        [&](std::size_t i) {
          return std::array{faces[i].hex, faces[i].face, association.face_surface[i]};
        },
        tuples(faces.size()));
}

/// What is written beside points and cells.
class VtkOutput {
 public:
  /// others: null where the format leaves them out.
  VtkOutput(const Mesh& mesh, const Association& association, const WriteOptions& options,
            const OtherCells* others = nullptr)
      : mesh_(mesh),
        association_(association),
        options_(options),
        others_(others && mesh.others ? others : nullptr),
        n_cells_(mesh.hexes.size() + (others_ ? others_->types.size() : 0)) {
    // Fields keep their names, wherever they are: arrays that we make ourselves have another then, which readers find.
    const auto is_field = [&](const std::string& name) {
      return std::ranges::find(mesh.fields, name, &Field::name) != mesh.fields.end() ||
             (others_ && std::ranges::find(mesh.others->heads->fields, name, &OtherField::name) !=
                             mesh.others->heads->fields.end());
    };
    const auto make = [&](std::string& name, const char* usual, bool wanted = true) {
      if (!wanted) return;
      for (name = usual; is_field(name);) name.insert(0, made_prefix);
      names_ += " " + name;
    };
    make(node_ids_, "node_id");
    make(owner_dims_, "owner_dim", !association.node_owner.empty());
    make(owner_ids_, "owner_id", !association.node_owner.empty());
    make(hex_ids_, "hex_id");
    make(volumes_, "volume", !association.hex_volume.empty());
    make(block_ids_, "block", !mesh.blocks.empty());
    make(shape_, "shape", options.write_quality && !is_field("shape"));
    make(jacobian_, "scaled_jacobian", options.write_quality && !is_field("scaled_jacobian"));
    block_of_cell_.resize(block_ids_.empty() ? 0 : n_cells_, 0);
    const auto put = [&](std::size_t cell, int id) {
      if (block_of_cell_[cell] == 0) block_of_cell_[cell] = id;
    };
    for (const Block& block : mesh.blocks) {
      if (block_ids_.empty()) break;
      for (const Index h : block.hexes) put(static_cast<std::size_t>(h), block.id);
      if (others_)
        for (const Index e : others_of_block(mesh, block.id))
          put(mesh.hexes.size() + static_cast<std::size_t>(e), block.id);
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!shape_.empty()) shapes_ = quality(Metric::shape, mesh), shapes_.resize(n_cells_, none);
    if (!jacobian_.empty()) jacobians_ = quality(Metric::scaled_jacobian, mesh), jacobians_.resize(n_cells_, none);
  }

  template <class Arrays>
  void field_data(Arrays& arrays) const {
    add_field_data(arrays, names_, mesh_, association_);
    if (others_) others_->add(arrays);
  }
  template <class Arrays>
  void point_data(Arrays& arrays) const {
    const auto n_nodes = mesh_.points.size();
    arrays.add_each(node_ids_, n_nodes, 1,
                    [this](std::size_t i) { return id_of(mesh_.node_ids, static_cast<Index>(i)); });
    if (!owner_dims_.empty()) {
      arrays.add_each(owner_dims_, n_nodes, 1, [this](std::size_t i) { return association_.node_owner[i].dim; });
      arrays.add_each(owner_ids_, n_nodes, 1, [this](std::size_t i) { return association_.node_owner[i].id; });
    }
    fields(arrays, Field::On::node);
  }
  template <class Arrays>
  void block_data(Arrays& arrays) const {
    if (!block_ids_.empty()) arrays.template add<int>(block_ids_, block_of_cell_, 1);
  }
  /// blocks: false where they have been written before.
  template <class Arrays>
  void cell_data(Arrays& arrays, bool blocks = true) const {
    arrays.add_each(hex_ids_, n_cells_, 1, [this, n_hexes = mesh_.hexes.size()](std::size_t i) {
      return i < n_hexes ? id_of(mesh_.hex_ids, static_cast<Index>(i)) : others_->ids[i - n_hexes];
    });
    if (!volumes_.empty())
      arrays.add_each(volumes_, n_cells_, 1, [this, n_hexes = mesh_.hexes.size()](std::size_t i) {
        return i < n_hexes ? association_.hex_volume[i] : 0;
      });
    if (blocks) block_data(arrays);
    if (!shape_.empty()) arrays.template add<double>(shape_, shapes_, 1);
    if (!jacobian_.empty()) arrays.template add<double>(jacobian_, jacobians_, 1);
    fields(arrays, Field::On::hex);
  }
  int nodes_per_hex() const { return options_.second ? options_.second->nodes_per_hex : 8; }
  /// Of so many components; T: of its numbers.
  template <class T = Index, class Arrays>
  void connectivity(Arrays& arrays, const std::string& name, int components) const {
    const SecondOrder* const second = options_.second;
    const auto add = [&]<int n>() {
      arrays.add_each(name, mesh_.hexes.size(), components,
                      [this, second](std::size_t h) { return cell_nodes<T, n>(mesh_, second, h); });
    };
    if (!second)
      add.template operator()<8>();
    else if (second->nodes_per_hex == 20)
      add.template operator()<20>();
    else
      add.template operator()<27>();
  }

 private:
  template <class Arrays>
  void fields(Arrays& arrays, Field::On on) const {
    const bool beside = others_ && on == Field::On::hex;
    for (const Field& field : mesh_.fields) {
      if (field.on != on) continue;
      if (beside) {
        field_beside(arrays, field);
      } else if (is_whole(field)) {
        arrays.add_each(field.name, field.values.size(), field.components,
                        [&values = field.values](std::size_t i) { return static_cast<std::int64_t>(values[i]); });
      } else {
        arrays.template add<double>(field.name, field.values, field.components);
      }
    }
    if (!beside) return;
    for (const OtherField* field : others_->only_theirs)
      arrays.add_each(field->name, n_cells_ * static_cast<std::size_t>(field->components), field->components,
                      [this, field, n = mesh_.hexes.size() * static_cast<std::size_t>(field->components)](
                          std::size_t i) { return i < n ? no_value : value_beside(*field, i - n); });
  }
  /// A field of hexes, with what other elements have of it.
  template <class Arrays>
  void field_beside(Arrays& arrays, const Field& field) const {
    const OtherField* theirs = nullptr;
    for (const OtherField& one : mesh_.others->heads->fields)
      if (one.name == field.name && one.components == field.components) theirs = &one;
    const auto value = [this, &values = field.values, theirs](std::size_t i) {
      if (i < values.size()) return values[i];
      return theirs ? value_beside(*theirs, i - values.size()) : no_value;
    };
    const std::size_t n = n_cells_ * static_cast<std::size_t>(field.components);
    if (is_whole(field))
      arrays.add_each(field.name, n, field.components, [value](std::size_t i) { return whole_number(value(i)); });
    else
      arrays.add_each(field.name, n, field.components, value);
  }
  /// Number i of the other elements as they are here; the field has the numbers of those of the file.
  double value_beside(const OtherField& field, std::size_t i) const {
    const auto width = static_cast<std::size_t>(field.components);
    return field.values[static_cast<std::size_t>(mesh_.others->of[i / width]) * width + i % width];
  }

  static constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
  const Mesh& mesh_;
  const Association& association_;
  const WriteOptions& options_;
  const OtherCells* others_;
  std::size_t n_cells_;
  // Names of arrays that are made here, empty: not there; and all of them.
  std::string node_ids_, owner_dims_, owner_ids_, hex_ids_, volumes_, block_ids_, shape_, jacobian_, names_;
  std::vector<int> block_of_cell_;
  std::vector<double> shapes_, jacobians_;
};

}  // namespace hextwist::io
