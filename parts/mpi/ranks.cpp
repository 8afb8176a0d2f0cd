#include "hextwist/parts/mpi/ranks.h"

#include <mpi.h>

#include <algorithm>
#include <new>

#include "hextwist/base/types.h"

namespace hextwist {
namespace {

constexpr int tag = 1;
/// A message holds at most so many bytes; longer ones are sent in pieces.
constexpr std::size_t longest_message = std::size_t{1} << 30;

std::int64_t reduced(std::int64_t value, MPI_Op op, MPI_Comm communicator) {
  std::int64_t result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_INT64_T, op, communicator);
  return result;
}

MPI_Comm of_handle(int handle) {
  return MPI_Comm_f2c(handle);
}

}  // namespace

Ranks::Ranks(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  communicator_ = MPI_Comm_c2f(MPI_COMM_WORLD);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::Ranks(int communicator) : is_ours_(false) {
  // A copy: our messages meet no others.
  MPI_Comm copy = MPI_COMM_NULL;
  MPI_Comm_dup(of_handle(communicator), &copy);
  communicator_ = MPI_Comm_c2f(copy);
  MPI_Comm_rank(copy, &rank_);
  MPI_Comm_size(copy, &size_);
}

Ranks::~Ranks() {
  if (is_ours_) {
    MPI_Finalize();
    return;
  }
  MPI_Comm copy = of_handle(communicator_);
  MPI_Comm_free(&copy);
}

std::int64_t Ranks::sum(std::int64_t value) {
  return reduced(value, MPI_SUM, of_handle(communicator_));
}
std::int64_t Ranks::least(std::int64_t value) {
  return reduced(value, MPI_MIN, of_handle(communicator_));
}
std::int64_t Ranks::largest(std::int64_t value) {
  return reduced(value, MPI_MAX, of_handle(communicator_));
}

std::vector<std::int64_t> Ranks::sum(std::vector<std::int64_t> values) {
  std::vector<std::int64_t> result(values.size());
  MPI_Allreduce(values.data(), result.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                of_handle(communicator_));
  return result;
}

std::vector<std::int64_t> Ranks::sum_before(std::vector<std::int64_t> values) {
  std::vector<std::int64_t> result(values.size(), 0);
  MPI_Exscan(values.data(), result.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
             of_handle(communicator_));
  if (rank_ == 0) std::ranges::fill(result, 0);
  return result;
}

std::vector<double> Ranks::largest(std::vector<double> values) {
  std::vector<double> result(values.size());
  MPI_Allreduce(values.data(), result.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                of_handle(communicator_));
  return result;
}

std::vector<std::vector<std::byte>> Ranks::everywhere(std::span<const std::byte> mine) {
  std::vector<std::vector<std::byte>> all(static_cast<std::size_t>(size_));
  for (int rank = 0; rank < size_; ++rank) {
    std::vector<std::byte>& bytes = all[rank];
    if (rank == rank_) bytes.assign(mine.begin(), mine.end());
    auto size = static_cast<std::int64_t>(bytes.size());
    MPI_Bcast(&size, 1, MPI_INT64_T, rank, of_handle(communicator_));
    bytes.resize(static_cast<std::size_t>(size));
    for (std::size_t at = 0; at < bytes.size(); at += longest_message)
      MPI_Bcast(bytes.data() + at, static_cast<int>(std::min(longest_message, bytes.size() - at)), MPI_BYTE, rank,
                of_handle(communicator_));
    if (rank == rank_ && size > 0) n_messages_ += size_ - 1, n_bytes_ += size * (size_ - 1);
  }
  return all;
}

std::string Ranks::text_of(int rank, const std::string& text) {
  std::string result = text;
  auto size = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, rank, of_handle(communicator_));
  result.resize(static_cast<std::size_t>(size));
  MPI_Bcast(result.data(), static_cast<int>(size), MPI_CHAR, rank, of_handle(communicator_));
  return result;
}

std::vector<std::string> Ranks::lines_of_all(const std::vector<std::string>& mine) {
  std::vector<char> text;
  for (const std::string& line : mine) text.insert(text.end(), line.c_str(), line.c_str() + line.size() + 1);
  std::vector<std::string> all;
  const std::vector<char> texts = joined_everywhere(text);
  for (std::size_t at = 0; at < texts.size();) {
    std::string line = &texts[at];
    at += line.size() + 1;
    if (std::ranges::find(all, line) == all.end()) all.push_back(std::move(line));
  }
  return all;
}

void Ranks::exchange_bytes(const std::vector<std::span<const std::byte>>& to,
                           const std::function<std::byte*(std::size_t, std::size_t)>& room) {
  const auto n = static_cast<std::size_t>(size_);
  std::vector<std::int64_t> to_size(n), from_size(n);
  for (std::size_t r = 0; r < n; ++r) to_size[r] = std::ssize(to[r]);
  MPI_Alltoall(to_size.data(), 1, MPI_INT64_T, from_size.data(), 1, MPI_INT64_T, of_handle(communicator_));
  std::vector<MPI_Request> requests;
  const auto in_messages = [&](std::size_t size, const auto& start) {
    for (std::size_t at = 0; at < size; at += longest_message) {
      requests.emplace_back();
      start(at, static_cast<int>(std::min(longest_message, size - at)), &requests.back());
    }
  };
  for (std::size_t r = 0; r < n; ++r) {
    const auto size = static_cast<std::size_t>(from_size[r]);
    std::byte* const place = room(r, size);
    if (r == static_cast<std::size_t>(rank_)) {
      std::ranges::copy(to[r], place);
      continue;
    }
    in_messages(size, [&](std::size_t at, int bytes, MPI_Request* request) {
      MPI_Irecv(place + at, bytes, MPI_BYTE, static_cast<int>(r), tag, of_handle(communicator_), request);
    });
  }
  for (std::size_t r = 0; r < n; ++r) {
    if (r == static_cast<std::size_t>(rank_)) continue;
    in_messages(to[r].size(), [&](std::size_t at, int bytes, MPI_Request* request) {
      MPI_Isend(to[r].data() + at, bytes, MPI_BYTE, static_cast<int>(r), tag, of_handle(communicator_), request);
      ++n_messages_;
      n_bytes_ += bytes;
    });
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void Ranks::together(const std::function<void()>& work) {
  std::string error;
  try {
    work();
  } catch (const std::bad_alloc&) {
    error = "out of memory";
  } catch (const std::exception& problem) {
    error = problem.what();
    if (error.empty()) error = "an error without a text";
  }
  const std::int64_t first = least(error.empty() ? size_ : rank_);
  if (first == size_) return;
  error = text_of(static_cast<int>(first), error);
  throw Error("rank " + std::to_string(first) + ": " + error);
}

}  // namespace hextwist
