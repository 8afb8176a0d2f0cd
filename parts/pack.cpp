#include "hextwist/parts/pack.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <fstream>

#include "hextwist/io/results.h"
#include "hextwist/mesh/arrays.h"

namespace hextwist {
namespace {

void put_text(ByteWriter& to, const std::string& text) {
  to.list(std::vector<char>(text.begin(), text.end()));
}
std::string text_from(ByteReader& from) {
  std::vector<char> text;
  from.list(text);
  return {text.begin(), text.end()};
}

template <class Groups>
void put_heads(ByteWriter& to, const Groups& groups) {
  to.value(groups.size());
  for (const auto& group : groups) {
    to.value(group.id);
    put_text(to, group.name);
    if constexpr (requires { group.meant; }) to.list(group.meant);
  }
}
template <class Groups>
void take_heads(ByteReader& from, Groups& groups) {
  groups.resize(from.value<std::size_t>());
  for (auto& group : groups) {
    group.id = from.value<int>();
    group.name = text_from(from);
    if constexpr (requires { group.meant; }) from.list(group.meant);
  }
}

void put_all(ByteWriter& to, const auto& items, const auto& put) {
  to.value(items.size());
  for (const auto& item : items) put(item);
}
void take_all(ByteReader& from, auto& items, const auto& take) {
  items.resize(from.value<std::size_t>());
  for (auto& item : items) take(item);
}

}  // namespace

void ByteReader::take(void* to, std::size_t n) {
  assert(n <= bytes_.size());
  if (n > 0) std::memcpy(to, bytes_.data(), n);
  bytes_ = bytes_.subspan(n);
}

std::vector<std::byte> packed(const MeshedModel& meshed) {
  ByteWriter to;
  put_heads(to, meshed.mesh.blocks);
  put_heads(to, meshed.mesh.node_sets);
  put_heads(to, meshed.mesh.side_sets);
  to.value(meshed.mesh.fields.size());
  for (const Field& field : meshed.mesh.fields) {
    put_text(to, field.name);
    to.value(field.on);
    to.value(field.components);
    to.value(field.integer);
  }
  for_each_array(lists_apart([&](const ArrayTag&, const auto& array) { to.list(array); }), meshed);
  return to.take();
}

MeshedModel unpacked(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  MeshedModel meshed;
  take_heads(from, meshed.mesh.blocks);
  take_heads(from, meshed.mesh.node_sets);
  take_heads(from, meshed.mesh.side_sets);
  meshed.mesh.fields.resize(from.value<std::size_t>());
  for (Field& field : meshed.mesh.fields) {
    field.name = text_from(from);
    field.on = from.value<Field::On>();
    field.components = from.value<int>();
    field.integer = from.value<bool>();
  }
  for_each_array(lists_apart([&](const ArrayTag&, auto& array) { from.list(array); }), meshed);
  return meshed;
}

std::vector<std::byte> packed_results(const FileResults* results) {
  ByteWriter to;
  if (!results) return {};
  const auto text = [&](const std::string& item) { put_text(to, item); };
  const auto factors = [&](const SetExtras& set) {
    to.value(set.id);
    to.list(set.factors);
  };
  to.list(results->times);
  put_all(to, results->of_all, [&](const TimedValues& values) {
    text(values.name);
    to.value((*values.at.at(0)).at(0));
  });
  put_all(to, results->node_sets, factors);
  put_all(to, results->side_sets, factors);
  put_all(to, results->properties, [&](const FileResults::Property& property) {
    to.value(property.of);
    text(property.name);
    to.list(property.values);
  });
  to.list(results->wide_ids);
  text(results->title);
  put_all(to, results->coordinate_names, text);
  put_all(to, results->info, text);
  put_all(to, results->qa, [&](const auto& record) { std::ranges::for_each(record, text); });
  return to.take();
}

std::shared_ptr<const FileResults> unpacked_results(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  FileResults results;
  const auto text = [&](std::string& item) { item = text_from(from); };
  const auto factors = [&](SetExtras& set) {
    set.id = from.value<int>();
    from.list(set.factors);
  };
  from.list(results.times);
  take_all(from, results.of_all, [&](TimedValues& values) {
    text(values.name);
    values.at.push_back(std::make_shared<const std::vector<double>>(1, from.value<double>()));
  });
  take_all(from, results.node_sets, factors);
  take_all(from, results.side_sets, factors);
  take_all(from, results.properties, [&](FileResults::Property& property) {
    property.of = from.value<FileResults::Of>();
    text(property.name);
    from.list(property.values);
  });
  from.list(results.wide_ids);
  text(results.title);
  take_all(from, results.coordinate_names, text);
  take_all(from, results.info, text);
  take_all(from, results.qa, [&](auto& record) { std::ranges::for_each(record, text); });
  return std::make_shared<const FileResults>(std::move(results));
}

Mesh heads_of(const Mesh& mesh) {
  Mesh heads;
  copy_heads(mesh, heads);
  heads.results = nullptr;
  return heads;
}

void write_bytes(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  std::ofstream to(file, std::ios::binary | std::ios::trunc);
  to.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  to.close();
  if (!to) throw Error(file.string() + ": cannot be written (disk full?)");
}

std::vector<std::byte> read_all_bytes(const std::filesystem::path& file) {
  std::ifstream from(file, std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(from ? static_cast<std::size_t>(from.tellg()) : 0);
  from.seekg(0);
  from.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!from) throw Error(file.string() + ": cannot be read");
  return bytes;
}

}  // namespace hextwist
