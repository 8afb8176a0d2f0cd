#include "hextwist/parts/pack.h"

#include <cassert>
#include <cstring>
#include <fstream>

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
