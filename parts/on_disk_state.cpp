#include "hextwist/parts/on_disk_internal.h"

#include <unistd.h>

#include "hextwist/base/types.h"
#include "hextwist/parts/pack.h"

namespace hextwist {

Aside::Aside(const std::filesystem::path& where) {
  std::string name = ((where.empty() ? std::filesystem::path(".") : where) / ".hextwist-parts-XXXXXX").string();
  if (!mkdtemp(name.data())) throw Error(name + ": this folder cannot be made");
  folder_ = name;
}
Aside::~Aside() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::int64_t SharedNodes::finish() {
  std::ranges::sort(all_);
  std::size_t n = 0;
  std::int64_t n_double = 0;
  for (std::size_t i = 0, j = 0; i < all_.size(); i = j) {
    for (j = i + 1; j < all_.size() && all_[j].first == all_[i].first;) ++j;
    if (j - i == 1) continue;
    n_double += static_cast<std::int64_t>(j - i) - 1;
    for (std::size_t k = i; k < j; ++k) all_[n++] = all_[k];
  }
  all_.resize(n);
  all_.shrink_to_fit();
  return n_double;
}

std::vector<std::byte> packed_state(const GlobalIds& ids, const std::vector<PassRecord>& records) {
  ByteWriter to;
  to.list(ids.node);
  to.list(ids.hex);
  to.value(ids.highest_node);
  to.value(ids.highest_hex);
  to.value(records.size());
  for (const PassRecord& record : records) {
    to.value(record.turn);
    for (const Index n : {record.n_old_nodes, record.n_old_hexes, record.n_nodes, record.n_hexes}) to.value(n);
    to.list(record.edges);
    to.list(record.faces);
    to.list(record.hexes);
    to.list(record.kept);
  }
  return to.take();
}
void unpack_state(std::span<const std::byte> bytes, GlobalIds& ids, std::vector<PassRecord>& records) {
  ByteReader from(bytes);
  from.list(ids.node);
  from.list(ids.hex);
  ids.highest_node = from.value<std::int64_t>();
  ids.highest_hex = from.value<std::int64_t>();
  records.resize(from.value<std::size_t>());
  for (PassRecord& record : records) {
    record.turn = from.value<Turn>();
    for (Index* n : {&record.n_old_nodes, &record.n_old_hexes, &record.n_nodes, &record.n_hexes})
      *n = from.value<Index>();
    from.list(record.edges);
    from.list(record.faces);
    from.list(record.hexes);
    from.list(record.kept);
  }
}

}  // namespace hextwist
