// A session that a page talks to: one command at a time on a thread of its own, so that it can be cancelled and looked
// at meanwhile.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hextwist/session/session.h"
#include "hextwist/session/view/before.h"
#include "hextwist/session/view/pack.h"

namespace hextwist::app {

class LiveSession {
 public:
  /// begin: what every session starts with (files of the command line), run as the first command. most_seconds: of a
  /// command, 0 for no limit.
  LiveSession(std::string title, std::function<void(Session&)> begin, double most_seconds);
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;

  /// False: something is running already.
  bool run(std::string text);
  void cancel();
  /// Cancels, and lets go of all who wait for events: from now on they get an answer at once.
  void end();

  /// What happened after event number `since`, as JSON {"events": [...], "running", "stage", "share", "version"}. Waits
  /// for something to happen, at most `patience`.
  std::string events(std::size_t since, std::chrono::milliseconds patience);

  /// Words for the end of a line; nothing while something is running.
  std::optional<std::vector<std::string>> completions(const std::string& line);

  /// A block of the scene, deflated: "skin" (with "meta"), "cad", "inside", "sets", "c0", ..., and with "before-" in
  /// front those of the mesh before the last change; as a difference from the one that was sent last, where `have` is
  /// its number. Nothing while something is running. Of no bytes where there is no such block.
  struct Sent {
    std::string bytes = {};
    std::size_t number = 0;
    bool is_difference = false;
    bool is_empty = false;  ///< there is no scene at all yet
  };
  std::optional<Sent> block(const std::string& name, std::size_t have);

  /// Files that commands of this session have written.
  bool has_written(const std::string& file);

  std::chrono::steady_clock::time_point last_seen();
  /// A command has ended it.
  bool has_quit() const { return has_quit_; }
  /// Its page was closed, or is being loaded anew.
  void leave();
  /// It is there again.
  void come_back();
  /// It left so long ago that it would be back by now.
  bool was_left();

 private:
  using Clock = std::chrono::steady_clock;
  void work(const std::stop_token& stop);
  void begin();
  void carry_out(const std::string& text);
  void tell(std::string event);
  void note_files(std::size_t first_record);
  PackedBlock made(const std::string& whole_name);

  const std::string title_;
  std::function<void(Session&)> begin_;
  const double most_seconds_;

  std::mutex session_mutex_;  // held while a command runs
  Session session_;
  std::map<std::string, std::pair<std::size_t, PackedBlock>> sent_;
  std::unique_ptr<MeshBefore> before_;  // null: not asked for since the last command

  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  std::vector<std::string> events_;
  std::size_t n_dropped_ = 0, version_ = 0, n_sent_ = 0;
  std::optional<std::string> wanted_;
  bool running_ = true, ended_ = false;
  std::optional<Clock::time_point> left_;
  std::string stage_;
  double share_ = 0;
  std::vector<std::string> written_;
  Clock::time_point seen_ = Clock::now(), began_ = Clock::now();
  std::atomic<bool> cancelled_ = false, too_long_ = false;
  bool is_safe_ = false;  // of the worker
  std::atomic<bool> has_quit_ = false;

  std::jthread worker_;  // the last one: it uses all the others
};

}  // namespace hextwist::app
