#include <limits>
#include <numeric>

#include "hextwist/base/large_array.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/format.h"

namespace hextwist::io {

void fail_at_item(const Cursor& cursor, std::span<const Run> runs, std::size_t item, const std::string& what) {
  if (runs.empty()) throw Error(std::string(cursor.name) + ": " + what);
  const auto run = std::ranges::upper_bound(runs, item, {}, &Run::first) - 1;
  const char* at = run->at;
  if (!cursor.binary)
    for (std::size_t k = run->first; k < item && at < cursor.end; ++k) {
      const auto* stop = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(cursor.end - at)));
      at = stop ? stop + 1 : cursor.end;
    }
  cursor.fail_at(at, what);
}

Ids::Ids(std::vector<std::int64_t> in_file_order, const char* kind, const Fail& fail_item)
    : ids_(std::move(in_file_order)) {
  const auto fail = [&](std::size_t item, const char* what) {
    fail_item(item, std::string(kind) + " id " + std::to_string(ids_[item]) + what);
  };
  if (ids_.empty()) return;
  const bool ascending = std::ranges::adjacent_find(ids_, std::ranges::greater_equal{}) == ids_.end();
  for (std::size_t i = 0; i < (ascending ? 1 : ids_.size()); ++i)
    if (ids_[i] < 1) fail(i, " is not positive");
  const auto [low, high] = std::ranges::minmax(ids_);
  if (high > highest_readable_id)
    fail(static_cast<std::size_t>(std::ranges::find(ids_, high) - ids_.begin()), " is too large");
  low_ = low;
  const auto range = static_cast<std::size_t>(high - low) + 1;
  contiguous_ = range == ids_.size();
  const bool dense = range / 4 <= ids_.size();
  if (!contiguous_ && dense) table_.assign(range, -1);
  if (ascending) {
    for (std::size_t i = 0; i < ids_.size() && !table_.empty(); ++i) table_[ids_[i] - low_] = static_cast<Index>(i);
    return;
  }
  // Else the items in ascending order of id.
  std::vector<Index> order;
  if (dense) {
    std::vector<Index> item_of_id(range, -1);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (item_of_id[ids_[i] - low_] >= 0) fail(i, " occurs twice");
      item_of_id[ids_[i] - low_] = static_cast<Index>(i);
    }
    if (!contiguous_) std::erase(item_of_id, -1);
    order = std::move(item_of_id);
  } else {
    order.resize(ids_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](Index i) { return ids_[i]; });
    for (std::size_t i = 1; i < order.size(); ++i)
      if (ids_[order[i]] == ids_[order[i - 1]]) fail(order[i], " occurs twice");
  }
  resize_for_overwrite(place_, order.size());
  std::vector<std::int64_t> sorted;
  resize_for_overwrite(sorted, order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place_[order[i]] = static_cast<Index>(i);
    sorted[i] = ids_[order[i]];
    if (!table_.empty()) table_[sorted[i] - low_] = static_cast<Index>(i);
  }
  ids_ = std::move(sorted);
}

Index Ids::find_sorted(std::int64_t id) const {
  return position_in(ids_, id);
}

std::vector<std::int64_t> Ids::stored() const {
  return contiguous_ && low_ == 1 ? std::vector<std::int64_t>{} : ids_;
}

Classes classify(const std::vector<int>& key_of_item, std::span<const std::span<const Index>> groups) {
  Classes result;
  // Neighbours mostly have the same key.
  for (std::size_t i = 0; i < key_of_item.size(); ++i)
    if (i == 0 || key_of_item[i] != key_of_item[i - 1]) result.key.push_back(key_of_item[i]);
  sort_unique(result.key);
  result.groups.resize(result.key.size());
  resize_for_overwrite(result.of_item, key_of_item.size());
  int of_key = 0;
  for (std::size_t i = 0; i < key_of_item.size(); ++i) {
    if (i == 0 || key_of_item[i] != key_of_item[i - 1]) of_key = position_in(result.key, key_of_item[i]);
    result.of_item[i] = of_key;
  }
  std::vector<int> moved;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    moved.assign(result.key.size(), -1);
    for (const Index i : groups[g]) {
      const int from = result.of_item[i];
      if (moved[from] < 0) {
        moved[from] = static_cast<int>(result.key.size());
        result.key.push_back(result.key[from]);
        result.groups.push_back(result.groups[from]);
        result.groups.back().push_back(static_cast<int>(g));
      }
      result.of_item[i] = moved[from];
    }
  }
  // Number the classes that are left by their first item.
  std::vector<int> number(result.key.size(), -1);
  Classes sorted;
  for (int& c : result.of_item) {
    if (number[c] < 0) {
      number[c] = static_cast<int>(sorted.key.size());
      sorted.key.push_back(result.key[c]);
      sorted.groups.push_back(std::move(result.groups[c]));
      sorted.count.push_back(0);
    }
    c = number[c];
    ++sorted.count[c];
  }
  sorted.of_item = std::move(result.of_item);
  return sorted;
}

std::string component_name(const std::string& name, int c, int n) {
  return name + "_" + (n == 3 ? std::string(1, static_cast<char>('x' + c)) : std::to_string(c + 1));
}

std::span<const std::int64_t> ids_in_file(const std::vector<std::int64_t>& ids, const char* kind, const char* many,
                                          std::int64_t highest, const char* limit, std::vector<std::string>& notices) {
  if (ids.empty() || ids.back() <= highest) return ids;
  notices.push_back(std::string(kind) + " id " + std::to_string(ids.back()) + " " + limit + ": " + many +
                    " are counted from 1 in the file");
  return {};
}

std::string one_line(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return name;
}

void say_renamed(const std::string& what, const std::string& name, const std::string& written,
                 std::vector<std::string>& notices) {
  if (!name.empty() && name != written)
    notices.push_back(what + " '" + name + "' is called '" + written + "' in the file");
}

void say_no_fields(const Mesh& mesh, const char* format, std::vector<std::string>& notices) {
  if (mesh.fields.empty()) return;
  std::string names;
  for (const Field& field : mesh.fields) names += (names.empty() ? "'" : ", '") + field.name + "'";
  notices.push_back(std::string(format) + " has no fields: " + names + " left out");
}

void say_rounded(const std::string& name, std::int64_t n, std::vector<std::string>& notices) {
  if (n > 0)
    notices.push_back("field '" + name + "': " + counted(n, "integer") + (n == 1 ? " is" : " are") +
                      " rounded, because fields have 53 bits of a number");
}

bool is_whole(const Field& field) {
  constexpr double most = 0x1p63;
  return field.integer && std::ranges::all_of(field.values, [](double x) { return x >= -most && x < most; });
}

std::vector<Field> split_components(const std::vector<Field>& fields, const std::function<bool(int)>& keep,
                                    std::vector<std::string>& notices) {
  std::vector<Field> result;
  for (const Field& field : fields) {
    const int n = field.components;
    if (n == 1 || keep(n)) {
      result.push_back(field);
      continue;
    }
    if (n != 3)  // name_x, name_y, name_z are vectors to all readers
      notices.push_back("the components of field '" + field.name + "' are the fields '" +
                        component_name(field.name, 0, n) + "' to '" + component_name(field.name, n - 1, n) +
                        "' in the file");
    for (int c = 0; c < n; ++c) {
      Field scalar{component_name(field.name, c, n), field.on, 1, {}};
      scalar.values.reserve(field.values.size() / n);
      for (std::size_t i = c; i < field.values.size(); i += n) scalar.values.push_back(field.values[i]);
      result.push_back(std::move(scalar));
    }
  }
  return result;
}

std::vector<Field> merge_components(std::vector<Field> scalars) {
  std::vector<Field> result;
  for (std::size_t i = 0; i < scalars.size();) {
    // How many of the following are components 0, 1, 2, ... of one name?
    const auto run = [&](int expected) {
      const std::string& first = scalars[i].name;
      const auto bar = first.rfind('_');
      if (bar == std::string::npos || bar == 0) return 0;
      const std::string stem = first.substr(0, bar);
      int n = 0;
      while (i + n < scalars.size() && scalars[i + n].components == 1 && scalars[i + n].on == scalars[i].on &&
             (expected != 3 || n < 3) && scalars[i + n].name == component_name(stem, n, expected))
        ++n;
      return expected == 3 ? (n == 3 ? 3 : 0) : n;
    };
    int n = run(3);
    if (n == 0) n = run(2);
    if (n < 2) {
      result.push_back(std::move(scalars[i++]));
      continue;
    }
    Field field{scalars[i].name.substr(0, scalars[i].name.rfind('_')), scalars[i].on, n, {}};
    const std::size_t size = scalars[i].values.size();
    field.values.resize(size * n);
    for (int c = 0; c < n; ++c)
      for (std::size_t k = 0; k < size; ++k) field.values[k * n + c] = scalars[i + c].values[k];
    result.push_back(std::move(field));
    i += n;
  }
  return result;
}

}  // namespace hextwist::io
