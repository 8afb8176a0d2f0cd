#include "hextwist/base/fenced.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

#include "hextwist/base/interrupt.h"
#include "hextwist/base/memory.h"
#include "hextwist/base/text.h"

extern char** environ;

namespace hextwist {
namespace {

// Descriptors of the reader.
constexpr int result_at = 3, alive_at = 4, input_at = 5;
/// Of both ends: a reader of another version is none.
constexpr const char* protocol = "hextwist 1";

enum Status { done = 0, refused = 1, out_of_memory = 2, not_ours = 3 };

struct Pipe {
  std::array<int, 2> end{-1, -1};
  Pipe() {
    if (::pipe2(end.data(), O_CLOEXEC) != 0) throw Error("no pipe can be made: " + error_text(errno));
  }
  ~Pipe() {
    for (const int e : end)
      if (e >= 0) ::close(e);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close(int which) { ::close(std::exchange(end[which], -1)); }
};

/// A process that is gone when this is.
struct Child {
  pid_t id = -1;
  int status = 0;
  bool known = false;  ///< how it ended; false: the host of this process collects its children itself
  ~Child() {
    if (id < 0) return;
    ::kill(id, SIGKILL);
    wait();
  }
  void wait() {
    pid_t got = -1;
    do got = ::waitpid(id, &status, 0);
    while (got < 0 && errno == EINTR);
    known = got == id;
    id = -1;
  }
};

struct SpawnActions {
  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
  explicit SpawnActions(int result, int alive, int input = -1) {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    // Libraries say on standard output and error what they like.
    for (const int to : {1, 2}) posix_spawn_file_actions_addopen(&files, to, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, result, result_at);
    posix_spawn_file_actions_adddup2(&files, alive, alive_at);
    if (input >= 0) posix_spawn_file_actions_adddup2(&files, input, input_at);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    // Ctrl-C is for the caller, which asks check_interrupt().
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnActions() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
};

/// Waits until nobody else holds the other end of this pipe, and asks check_interrupt() meanwhile.
void wait_for_end(int descriptor) {
  pollfd end{descriptor, 0, 0};
  // Ctrl-C ends the waiting itself: that is what is to be asked about.
  for (int n = ::poll(&end, 1, 50); n == 0 || (n < 0 && errno == EINTR); n = ::poll(&end, 1, 50)) check_interrupt();
}

/// Above what the child's own descriptors are, so that none covers another.
int out_of_the_way(int descriptor) {
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 10);
  if (copy < 0) throw Error("no descriptor is free: " + error_text(errno));
  return copy;
}

/// Runs a program until it ends: text is its path and its words. started: called once it runs. Returns 0, or why it
/// can't be started.
template <class Started>
int run_to_the_end(Child& child, std::vector<std::string> text, char* const* environment, const Handover& out,
                   const Handover* in, const Started& started) {
  std::vector<char*> words;
  words.reserve(text.size() + 1);
  for (std::string& word : text) words.push_back(word.data());
  words.push_back(nullptr);
  Pipe alive;
  {
    const int result = out_of_the_way(out.descriptor()), held = out_of_the_way(alive.end[1]),
              input = in ? out_of_the_way(in->descriptor()) : -1;
    const SpawnActions actions(result, held, input);
    const int failed = posix_spawn(&child.id, words[0], &actions.files, &actions.attributes, words.data(), environment);
    for (const int descriptor : {result, held, input})
      if (descriptor >= 0) ::close(descriptor);
    if (failed) {
      child.id = -1;
      return failed;
    }
  }
  started(child.id);
  // The pipe ends when the child does.
  alive.close(1);
  wait_for_end(alive.end[0]);
  child.wait();
  return 0;
}

/// more: until the program is ended without a word, which SIGXCPU would have been.
void limit(int resource, double most, rlim_t more = 0) {
  const auto value = static_cast<rlim_t>(most);
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min<rlim_t>(now.rlim_max, value);
  now.rlim_max = std::min<rlim_t>(now.rlim_max, value + more);
  setrlimit(resource, &now);
}

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::filesystem::path find_readers() {
  if (const char* said = std::getenv("HEXTWIST_READERS"); said && *said) return said;
  Dl_info here{};
  std::error_code error;
  std::filesystem::path folder;
  // A program is called as its caller likes, also like a file that lies in the working folder by chance.
  if (dladdr(reinterpret_cast<const void*>(&find_readers), &here) != 0 && here.dli_fname && here.dli_fname[0] == '/')
    folder = std::filesystem::canonical(here.dli_fname, error).parent_path();
  if (error || folder.empty()) folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {".", "../libexec/hextwist", "../../libexec/hextwist", "../../../../libexec/hextwist"}) {
    std::filesystem::path readers = (folder / place).lexically_normal();
    if (::access((readers / "hextwist_read_cad").c_str(), X_OK) == 0) return readers;
  }
  return {};
}

bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path top = std::filesystem::canonical(folder, error);
  if (error) return false;
  // A link to nothing would be followed when the file is made.
  const std::filesystem::path whole = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
  if (error || std::filesystem::is_symlink(std::filesystem::symlink_status(whole, error))) return false;
  const auto way = whole.lexically_relative(top);
  return !way.empty() && *way.begin() != "..";
}

Handover::Handover() : descriptor_(::memfd_create("hextwist", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw Error("no memory to hand a file over: " + error_text(errno));
}
Handover::~Handover() {
  ::close(descriptor_);
}
std::filesystem::path Handover::path() const {
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

void read_fenced(const Fence& fence, const std::string& kind, const std::filesystem::path& file,
                 const std::vector<std::string>& words, const Handover& to, std::uintmax_t more_bytes) {
  const std::string name = file.string();
  if (fence.readers.empty())
    throw Error(name + ": the programs that read such files, hextwist_read_cad and its like, are not installed");
  std::error_code error;
  const double size = static_cast<double>(std::filesystem::file_size(file, error) + more_bytes) / 1e6;
  if (error) throw Error(name + ": cannot be read: " + error.message());
  const double seconds = std::ceil(fence.seconds > 0 ? fence.seconds : 20 + 60 * size);
  const double free = static_cast<double>(available_memory()) / 1e6;
  const double megabytes = fence.megabytes > 0 ? fence.megabytes : std::min(4000 + 200 * size, std::max(1000.0, free));

  const std::string reader = (fence.readers / ("hextwist_read_" + kind)).string();
  std::vector<std::string> text = {reader, protocol, name, short_number(seconds, 12), short_number(megabytes, 12)};
  text.insert(text.end(), words.begin(), words.end());
  Child child;
  if (const int failed = run_to_the_end(child, std::move(text), environ, to, nullptr, [](pid_t) {}))
    throw Error(name + ": the program that reads it, " + reader + ", cannot be started: " + error_text(failed));

  const bool ended = child.known && WIFEXITED(child.status);
  const int status = ended ? WEXITSTATUS(child.status) : -1;
  if (ended && status == done) return;
  const std::string memory = "reading it takes more than " + short_number(megabytes, 6) +
                             " MB of memory: the file is damaged, or 'set reading memory' allows more";
  if (ended && status == refused) {
    const std::string said = content(to.path());
    throw Error(said.empty() ? name + ": cannot be read" : said);
  }
  if (ended && status == out_of_memory) throw Error(name + ": " + memory);
  if (ended && status == not_ours) throw Error(name + ": " + reader + " is of another version");
  if (ended)
    throw Error(name + ": reading it failed (" + reader + " ended with status " + std::to_string(status) + ")");
  if (!child.known) throw Error(name + ": reading it ended in an unknown way (children are not waited for here)");
  const int signal = WTERMSIG(child.status);
  if (signal == SIGXCPU)
    throw Error(name + ": reading it takes more than " + short_number(seconds, 6) +
                " s of CPU time: the file is damaged, or 'set reading time' allows more");
  if (signal == SIGKILL) throw Error(name + ": reading it was ended from outside (no memory left?)");
  throw Error(name + ": reading it crashed (" + lower_case(strsignal(signal)) + "): the file is damaged");
}

std::filesystem::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string_view left = path ? path : "";
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(':'), left.size());
    const std::filesystem::path folder(left.substr(0, end));
    left.remove_prefix(std::min(end + 1, left.size()));
    // Not one in the working folder, which may be anybody's.
    if (folder.is_absolute() && ::access((folder / name).c_str(), X_OK) == 0) return folder / name;
  }
  return {};
}

void run_within(double seconds, double megabytes, const std::filesystem::path& program,
                const std::vector<std::string>& arguments, const Handover& in, const Handover& out) {
  const std::string name = program.filename().string();
  std::vector<std::string> text{program.string()};
  for (const std::string& argument : arguments)
    text.push_back(argument == "{in}"    ? "/proc/self/fd/" + std::to_string(input_at)
                   : argument == "{out}" ? "/proc/self/fd/" + std::to_string(result_at)
                                         : argument);
  // No settings of whoever is at home here.
  const char* path = std::getenv("PATH");
  std::array<std::string, 3> settings = {std::string("PATH=") + (path ? path : ""), "HOME=/nonexistent", "LC_ALL=C"};
  std::array<char*, 4> environment = {settings[0].data(), settings[1].data(), settings[2].data(), nullptr};

  Child child;
  const auto keep_within = [&](pid_t id) {
    const auto within = [id](auto resource, double most) {
      const rlimit limits{static_cast<rlim_t>(most), static_cast<rlim_t>(most)};
      ::prlimit(id, resource, &limits, nullptr);
    };
    within(RLIMIT_CORE, 0);
    within(RLIMIT_CPU, std::ceil(seconds));
    within(RLIMIT_FSIZE, megabytes * 1e6);
    within(RLIMIT_AS, megabytes * 1e6);
  };
  if (const int failed = run_to_the_end(child, std::move(text), environment.data(), out, &in, keep_within))
    throw Error(name + " cannot be started: " + error_text(failed));
  if (!child.known) return;  // the host of this process collects its children itself: what there is tells
  if (WIFEXITED(child.status) && WEXITSTATUS(child.status) == 0) return;
  if (WIFEXITED(child.status))
    throw Error(name + " failed (it ended with status " + std::to_string(WEXITSTATUS(child.status)) + ")");
  const int signal = WTERMSIG(child.status);
  if (signal == SIGKILL || signal == SIGXCPU)
    throw Error(name + " took more than " + short_number(seconds, 6) + " s of CPU time, or was ended from outside");
  throw Error(name + " crashed (" + lower_case(strsignal(signal)) + ")");
}

int serve_fenced(int argc, char** argv, const std::function<void(const FencedJob&)>& read) {
  if (argc < 5 || std::string_view(argv[1]) != protocol) return not_ours;
  // Ends with who waits for it.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const double seconds = std::strtod(argv[3], nullptr), megabytes = std::strtod(argv[4], nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds, 2);
  limit(RLIMIT_FSIZE, megabytes * 1e6);
  if (!is_sanitized) limit(RLIMIT_AS, megabytes * 1e6);
  const FencedJob job{argv[2], "/proc/self/fd/" + std::to_string(result_at), {argv + 5, argv + argc}};
  const auto say = [&](const std::string& text) {
    std::ofstream(job.to, std::ios::binary | std::ios::trunc) << text;
    return refused;
  };
  try {
    read(job);
    return done;
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  } catch (const std::exception& error) {
    return say(error.what());
  }
}

void put(std::ostream& out, const void* bytes, std::size_t n) {
  out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(n));
}
void put(std::ostream& out, const std::string& text) {
  put_all(out, std::vector<char>(text.begin(), text.end()));
}
void take(std::istream& in, void* bytes, std::size_t n) {
  if (!in.read(static_cast<char*>(bytes), static_cast<std::streamsize>(n)))
    throw Error("the reader has left too little");
}
std::string take_text(std::istream& in) {
  const auto text = take_all<char>(in);
  return {text.begin(), text.end()};
}

}  // namespace hextwist
