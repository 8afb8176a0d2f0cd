// Messages between the processes that share a mesh. MPI is seen here alone, and by the call for other programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace hextwist {

/// Told a line, on all ranks.
using Say = std::function<void(const std::string&)>;

/// All calls are made by all ranks, in the same order.
class Ranks {
 public:
  /// Begins with MPI, and ends with it in the destructor.
  Ranks(int& argc, char**& argv);
  /// Of another program's communicator, by its handle for Fortran (MPI_Comm_c2f). Leaves it, and MPI, as it is.
  explicit Ranks(int communicator);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_first() const { return rank_ == 0; }

  /// Sends to[r] to each rank r; returns what came from each.
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::span<const std::byte>> bytes;
    for (const std::vector<T>& list : to) bytes.push_back(std::as_bytes(std::span(list)));
    std::vector<std::vector<T>> from(to.size());
    exchange_bytes(bytes, [&](std::size_t rank, std::size_t size) {
      from[rank].resize(size / sizeof(T));
      return reinterpret_cast<std::byte*>(from[rank].data());
    });
    return from;
  }
  std::int64_t sum(std::int64_t value);
  std::vector<std::int64_t> sum(std::vector<std::int64_t> values);
  std::int64_t least(std::int64_t value);
  std::int64_t largest(std::int64_t value);
  /// The sums of the values of the ranks before.
  std::vector<std::int64_t> sum_before(std::vector<std::int64_t> values);
  std::vector<double> largest(std::vector<double> values);
  /// The text of one rank, everywhere.
  std::string text_of(int rank, const std::string& text);
  /// The lines of all ranks, rank after rank and each once; everywhere.
  std::vector<std::string> lines_of_all(const std::vector<std::string>& mine);
  /// The lists of all ranks, one after the other; everywhere.
  template <class T>
  std::vector<T> joined_everywhere(const std::vector<T>& mine) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all;
    for (const std::vector<std::byte>& bytes : everywhere(std::as_bytes(std::span(mine)))) {
      const std::size_t before = all.size();
      all.resize(before + bytes.size() / sizeof(T));
      if (!bytes.empty()) std::memcpy(&all[before], bytes.data(), bytes.size());
    }
    return all;
  }
  /// The bytes of each rank, everywhere.
  std::vector<std::vector<std::byte>> everywhere(std::span<const std::byte> mine);

  /// Each rank does its work, which sends nothing. Where it throws on one of them, all throw Error: "rank 3: ...".
  void together(const std::function<void()>& work);

  /// What was sent by exchange() so far: by this rank, to others.
  std::int64_t n_messages() const { return n_messages_; }
  std::int64_t n_bytes() const { return n_bytes_; }

 private:
  void exchange_bytes(const std::vector<std::span<const std::byte>>& to,
                      const std::function<std::byte*(std::size_t, std::size_t)>& room);
  int rank_ = 0, size_ = 1;
  int communicator_ = 0;
  bool is_ours_ = true;
  std::int64_t n_messages_ = 0, n_bytes_ = 0;
};

}  // namespace hextwist
