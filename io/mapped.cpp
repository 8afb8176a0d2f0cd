#include "hextwist/io/mapped.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>

namespace hextwist::io {
namespace {

/// Read by the signal's handler, so without a lock; a place is free where begin is 0.
struct Mapping {
  std::atomic<std::uintptr_t> begin = 0;
  std::atomic<std::size_t> size = 0;
  std::atomic<bool> cut = false;
  int descriptor = -1;
  struct stat status {};
};
std::array<Mapping, 64> mappings;
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free);

const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));

std::mutex changing;
int n_mapped = 0;
struct sigaction before {};

extern "C" void on_bus_error(int signal, siginfo_t* info, void* context) {
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (Mapping& mapping : mappings) {
    const std::uintptr_t begin = mapping.begin;
    if (begin == 0 || at < begin || at >= begin + mapping.size) continue;
    void* const start = reinterpret_cast<void*>(at / page * page);
    if (::mmap(start, page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED) break;
    mapping.cut = true;
    return;
  }
  if (before.sa_flags & SA_SIGINFO)
    before.sa_sigaction(signal, info, context);
  else if (before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN)
    before.sa_handler(signal);
  else
    ::signal(signal, SIG_DFL);  // and it comes again
}

Mapping* mapping_at(const char* data) {
  for (Mapping& mapping : mappings)
    if (mapping.begin == reinterpret_cast<std::uintptr_t>(data)) return &mapping;
  return nullptr;
}

}  // namespace

const char* map(int descriptor, std::size_t size) {
  const std::lock_guard lock(changing);
  Mapping* const free = mapping_at(nullptr);
  if (!free) return nullptr;
  void* const mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (mapped == MAP_FAILED) return nullptr;
  if (n_mapped++ == 0) {
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGBUS, &action, &before);
  }
  free->descriptor = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
  if (::fstat(descriptor, &free->status) != 0) free->status = {};
  free->cut = false;
  free->size = size;
  free->begin = reinterpret_cast<std::uintptr_t>(mapped);
  return static_cast<const char*>(mapped);
}

void unmap(const char* data, std::size_t size) {
  const std::lock_guard lock(changing);
  if (Mapping* mapping = mapping_at(data)) {
    mapping->begin = 0;
    if (mapping->descriptor >= 0) ::close(mapping->descriptor);
  }
  ::munmap(const_cast<char*>(data), size);
  if (--n_mapped > 0) return;
  struct sigaction now {};
  // Unless somebody has put a handler in place of this one.
  if (::sigaction(SIGBUS, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) && now.sa_sigaction == on_bus_error)
    ::sigaction(SIGBUS, &before, nullptr);
}

bool has_changed(const char* data) {
  const Mapping* mapping = mapping_at(data);
  if (!mapping) return false;
  struct stat now {};
  return mapping->cut || ::fstat(mapping->descriptor, &now) != 0 || now.st_size != mapping->status.st_size ||
         now.st_mtim.tv_sec != mapping->status.st_mtim.tv_sec || now.st_mtim.tv_nsec != mapping->status.st_mtim.tv_nsec;
}

}  // namespace hextwist::io
