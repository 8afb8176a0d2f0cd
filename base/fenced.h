// Both ends of a fence (fence.h): who has a file read, and the program that reads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"

namespace hextwist {

/// What the reader leaves: a file without a name, gone with this.
class Handover {
 public:
  Handover();
  ~Handover();
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  int descriptor() const { return descriptor_; }
  /// A name by which it can be opened as long as this lives.
  std::filesystem::path path() const;

 private:
  int descriptor_ = -1;
};

/// Has the file read by the program hextwist_read_<kind>, which fills `to`. Waits, and asks check_interrupt()
/// meanwhile. Throws Error: what the reader says is wrong with the file, or how it ended. more_bytes: of other files
/// that belong to it, which count for the limits.
void read_fenced(const Fence& fence, const std::string& kind, const std::filesystem::path& file,
                 const std::vector<std::string>& words, const Handover& to, std::uintmax_t more_bytes = 0);

/// Where the program of that name lies in a folder of PATH; empty: nowhere.
std::filesystem::path find_program(const std::string& name);

/// Runs a program of somebody else within limits, with nothing of the environment but PATH. Among its arguments
/// "{in}" stands for the name of `in`, "{out}" for that of `out`. Waits, and asks check_interrupt() meanwhile. Throws
/// Error, saying how it ended, unless it ended well. seconds: of CPU time; megabytes: of address space.
void run_within(double seconds, double megabytes, const std::filesystem::path& program,
                const std::vector<std::string>& arguments, const Handover& in, const Handover& out);

/// The program's end: sets the limits that the command line names, calls `read` with the file, the words and where to
/// write, and tells the caller of errors. Returns the status to end with.
struct FencedJob {
  std::filesystem::path file, to;
  std::vector<std::string> words;
};
int serve_fenced(int argc, char** argv, const std::function<void(const FencedJob&)>& read);

/// Numbers and texts as the handover has them, in the machine's own form: both ends are on one machine and of one
/// version. Those that read throw Error where there is not enough.
void put(std::ostream& out, const void* bytes, std::size_t n);
void put(std::ostream& out, const std::string& text);
void take(std::istream& in, void* bytes, std::size_t n);
std::string take_text(std::istream& in);
template <class T>
void put_all(std::ostream& out, const std::vector<T>& items) {
  const std::size_t n = items.size();
  put(out, &n, sizeof n);
  put(out, items.data(), n * sizeof(T));
}
template <class T>
std::vector<T> take_all(std::istream& in) {
  std::size_t n = 0;
  take(in, &n, sizeof n);
  std::vector<T> items(n);
  take(in, items.data(), n * sizeof(T));
  return items;
}

}  // namespace hextwist
