// Elements beside the hexes in Exodus II.
#include <numeric>
#include <optional>

#include "hextwist/io/exodus/reader_internal.h"

namespace hextwist::io {

std::string ExodusReader::only_others() const {
  std::string text;
  for (const FileBlock& block : blocks_)
    if (block.n > 0)
      text += (text.empty() ? ", but " : ", ") + std::to_string(block.n) + " " +
              heads_.types[heads_.type[other_of(block.first)]].name + " (element block " + std::to_string(block.id) +
              ")";
  return text;
}

void ExodusReader::other_blocks() {
  if (heads_.ids.empty()) return;
  const Ids ids(heads_.ids, "element", [&](std::size_t, const std::string& what) { fail(what); });
  for (const std::int64_t id : heads_.ids)
    if (hexes_.find(id) >= 0) fail("element id " + std::to_string(id) + " occurs twice");
  for (const FileBlock& block : blocks_) {
    if (block.hexes || block.n == 0) continue;
    const int id = group_id(EX_ELEM_BLOCK, block.id);
    const std::string name = group_name(EX_ELEM_BLOCK, block.id);
    other_attributes(block);
    if (name == exodus_rest_block) continue;
    group_of_id(out_.mesh.blocks, id).name = name;
    OtherSet set{id, std::vector<Index>(static_cast<std::size_t>(block.n))};
    std::iota(set.elements.begin(), set.elements.end(), other_of(block.first));
    heads_.sets.push_back(std::move(set));
  }
}

void ExodusReader::other_attributes(const FileBlock& block) {
  int n = 0;
  if (ex_get_attr_param(file_.id, EX_ELEM_BLOCK, block.id, &n) < 0 || n <= 0) return;
  const std::size_t length = std::max<std::size_t>(name_length_, MAX_STR_LENGTH) + 1;
  std::vector<std::string> names(size(n, "attributes"), std::string(length, '\0'));
  std::vector<char*> pointers;
  for (std::string& name : names) pointers.push_back(name.data());
  check(ex_get_attr_names(file_.id, EX_ELEM_BLOCK, block.id, pointers.data()), "names of attributes");
  for (std::size_t a = 0; a < names.size(); ++a) {
    OtherField field{std::string(trimmed(names[a].c_str())), 1, {}, true, false};
    if (field.name.empty()) field.name = "attribute_" + std::to_string(a + 1);
    std::vector<double> of_block(static_cast<std::size_t>(block.n));
    check(ex_get_one_attr(file_.id, EX_ELEM_BLOCK, block.id, static_cast<int>(a) + 1, of_block.data()),
          "attribute " + field.name);
    field.values.assign(heads_.ids.size(), std::numeric_limits<double>::quiet_NaN());
    std::ranges::copy(of_block, field.values.begin() + other_of(block.first));
    heads_.fields.push_back(std::move(field));
  }
}

void ExodusReader::finish_others() {
  if (heads_.ids.empty()) return;
  std::vector<std::string> lost;
  int n = 0;
  if (ex_get_variable_param(file_.id, EX_ELEM_BLOCK, &n) >= 0 && n > 0 && ex_inquire_int(file_.id, EX_INQ_TIME) > 0)
    for (int v = 1; v <= n; ++v)
      for (const FileBlock& block : blocks_) {
        if (block.hexes || block.n == 0) continue;
        std::vector<double> values(static_cast<std::size_t>(block.n));
        if (ex_get_var(file_.id, 1, EX_ELEM_BLOCK, v, block.id, block.n, values.data()) != 0) continue;
        lost.push_back(std::to_string(block.id));
      }
  sort_unique(lost);
  if (!lost.empty())
    out_.notices.push_back("dropped the variables of other elements (element block" +
                           std::string(lost.size() == 1 ? " " : "s ") + joined(lost, ", ") + ")");
  out_.mesh.others = other_elements(std::move(heads_), std::move(other_first_), std::move(other_nodes_));
}

int ExodusReader::other_type(const char* name, const std::string& lower, int n_nodes) {
  const auto starts = [&](std::string_view word) { return lower.starts_with(word); };
  const auto one_of = [&](std::initializer_list<int> known) {
    return std::ranges::find(known, n_nodes) != known.end();
  };
  std::optional<OtherShape> shape;
  if (starts("sphere") || starts("circle") || starts("point") || n_nodes == 1)
    shape = n_nodes == 1 ? std::optional(OtherShape::point) : std::nullopt;
  else if (starts("bar") || starts("beam") || starts("truss") || starts("edge") || starts("rod") || starts("line"))
    shape = one_of({2, 3}) ? std::optional(OtherShape::line) : std::nullopt;
  else if (starts("tri") || (starts("shell") && one_of({3, 6, 7})))
    shape = one_of({3, 4, 6, 7}) ? std::optional(OtherShape::triangle) : std::nullopt;
  else if (starts("quad") || starts("shell"))
    shape = one_of({4, 5, 8, 9}) ? std::optional(OtherShape::quad) : std::nullopt;
  else if (starts("tet"))
    shape = one_of({4, 5, 8, 10, 11, 14, 15}) ? std::optional(OtherShape::tetrahedron) : std::nullopt;
  else if (starts("pyr"))
    shape = one_of({5, 13, 14, 18, 19}) ? std::optional(OtherShape::pyramid) : std::nullopt;
  else if (starts("wedge"))
    shape = one_of({6, 15, 16, 18, 20, 21}) ? std::optional(OtherShape::wedge) : std::nullopt;
  if (!shape) return -1;
  const OtherType type{*shape, n_nodes, name};
  const auto place = std::ranges::find(heads_.types, type) - heads_.types.begin();
  if (place == std::ssize(heads_.types)) heads_.types.push_back(type);
  return static_cast<int>(place);
}

}  // namespace hextwist::io
