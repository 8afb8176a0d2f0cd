#include "live_session.h"

#include <algorithm>
#include <new>

#include "hextwist/base/text.h"
#include "hextwist/command/syntax.h"
#include "hextwist/session/core.h"
#include "hextwist/session/record_json.h"
#include "hextwist/session/view/scene.h"

namespace hextwist::app {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_events = 4000;
constexpr auto reload_time = 10s;
constexpr std::string_view before_prefix = "before-";

/// The name of a block in its scene.
std::string_view without_prefix(std::string_view name) {
  return name.starts_with(before_prefix) ? name.substr(before_prefix.size()) : name;
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Does a command leave the mesh, its model and its sets alone?
bool only_looks(const std::string& command) {
  constexpr const char* names[] = {"list", "quality", "draw", "help", "check", "export", "record", "set"};
  const std::string word = lower_case(command.substr(0, command.find_first_of(" \t")));
  return std::ranges::any_of(names, [&](const char* name) { return word == name; });
}

}  // namespace

LiveSession::LiveSession(std::string title, std::function<void(Session&)> begin, double most_seconds)
    : title_(std::move(title)),
      begin_(std::move(begin)),
      most_seconds_(most_seconds),
      worker_([this](const std::stop_token& stop) { work(stop); }) {}

LiveSession::~LiveSession() {
  cancelled_ = true;
  worker_.request_stop();
  changed_.notify_all();
}

void LiveSession::tell(std::string event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
  if (events_.size() > most_events) {
    events_.erase(events_.begin(), events_.begin() + most_events / 4);
    n_dropped_ += most_events / 4;
  }
  changed_.notify_all();
}

bool LiveSession::run(std::string text) {
  const std::lock_guard lock(mutex_);
  seen_ = Clock::now();
  if (running_) return false;
  running_ = true;
  stage_.clear();
  share_ = 0;
  cancelled_ = too_long_ = false;
  wanted_ = std::move(text);
  changed_.notify_all();
  return true;
}

void LiveSession::cancel() {
  cancelled_ = true;
}

void LiveSession::end() {
  cancel();
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void LiveSession::work(const std::stop_token& stop) {
  const auto say = [this](const char* kind, const std::string& text) {
    tell(text_of({{"kind", kind}, {"text", text}}));
  };
  session_.set_callbacks({
      .output = [say](const std::string& line) { say("output", line); },
      .notice = [say](const std::string& line) { say("note", "note: " + line); },
      .error = [say](const CommandError& error) { say("error", std::string("error: ") + error.what()); },
      .progress =
          [this](const char* stage, double share) {
            const std::lock_guard lock(mutex_);
            stage_ = stage;
            share_ = share;
            if (most_seconds_ > 0 && Clock::now() - began_ > std::chrono::duration<double>(most_seconds_))
              cancelled_ = too_long_ = true;
            return !cancelled_;
          },
  });
  carry_out("");
  while (!stop.stop_requested()) {
    std::optional<std::string> text;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, stop, [this] { return wanted_.has_value(); });
      text = std::exchange(wanted_, std::nullopt);
    }
    if (text) carry_out(*text);
  }
}

void LiveSession::begin() {
  std::exception_ptr problem;
  try {
    begin_(session_);
  } catch (...) {
    problem = std::current_exception();
  }
  // Whatever has become of the rest, also where it was cancelled or took too long.
  {
    const std::lock_guard lock(mutex_);
    began_ = Clock::now();
    cancelled_ = false;
  }
  session_.run("set safe on");
  is_safe_ = true;
  if (problem) std::rethrow_exception(problem);
}

void LiveSession::carry_out(const std::string& text) {
  bool is_changed = text.empty();
  std::string error;
  {
    const std::lock_guard session(session_mutex_);
    {
      const std::lock_guard lock(mutex_);
      began_ = Clock::now();
    }
    if (!text.empty()) tell(text_of({{"kind", "command"}, {"text", text}}));
    const std::size_t before = session_.records().size();
    before_.reset();
    try {
      if (text.empty())
        begin();
      else if (is_safe_)
        session_.run(text);
      else
        error = "this session could not be made safe: nothing is run in it";
    } catch (const std::bad_alloc&) {
      error = "out of memory";
    } catch (const std::exception& problem) {
      error = too_long_ ? "cancelled: it took more than " + short_number(most_seconds_) + " s" : problem.what();
    }
    for (std::size_t i = before; i < session_.records().size(); ++i) {
      const CommandRecord& record = session_.records()[i];
      is_changed = is_changed || (record.ok && !only_looks(record.command));
      tell(text_of({{"kind", "record"}, {"record", record_json(record)}}));
    }
    note_files(before);
  }
  if (!error.empty()) tell(text_of({{"kind", "error"}, {"text", "error: " + error}}));
  const std::lock_guard lock(mutex_);
  has_quit_ = session_.finished();
  if (is_changed) ++version_;
  running_ = false;
  changed_.notify_all();
}

void LiveSession::note_files(std::size_t first_record) {
  for (std::size_t i = first_record; i < session_.records().size(); ++i) {
    const CommandRecord& record = session_.records()[i];
    if (!record.ok) continue;
    for (const Statement& statement : split_statements(record.command)) {
      try {
        const Command command = parse(statement);
        const Item* file = command.find("file");
        if (!file || (command.spec->name != "export" && command.spec->name != "draw" && command.spec->name != "record"))
          continue;
        tell(text_of({{"kind", "file"}, {"text", file->text}}));
        const std::lock_guard lock(mutex_);
        written_.push_back(file->text);
      } catch (const CommandError&) {
        continue;  // with expressions in braces: no file to offer
      }
    }
  }
}

bool LiveSession::has_written(const std::string& file) {
  const std::lock_guard lock(mutex_);
  return std::ranges::find(written_, file) != written_.end();
}

LiveSession::Clock::time_point LiveSession::last_seen() {
  const std::lock_guard lock(mutex_);
  return seen_;
}

bool LiveSession::was_left() {
  const std::lock_guard lock(mutex_);
  return left_ && Clock::now() - *left_ > reload_time;
}

void LiveSession::leave() {
  const std::lock_guard lock(mutex_);
  left_ = Clock::now();
  changed_.notify_all();
}

void LiveSession::come_back() {
  const std::lock_guard lock(mutex_);
  left_ = std::nullopt;
}

std::string LiveSession::events(std::size_t since, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  seen_ = Clock::now();
  left_ = std::nullopt;
  const bool was_running = running_;
  // While something runs, its progress is news.
  if (was_running) patience = std::min<std::chrono::milliseconds>(patience, 250ms);
  changed_.wait_for(lock, patience,
                    [&] { return ended_ || left_ || n_dropped_ + events_.size() > since || running_ != was_running; });
  const std::size_t first = std::max(since, n_dropped_);
  std::string list;
  for (std::size_t i = first; i < n_dropped_ + events_.size(); ++i)
    list += (list.empty() ? "" : ",") + events_[i - n_dropped_];
  return "{\"events\":[" + list + "],\"next\":" + std::to_string(n_dropped_ + events_.size()) +
         ",\"running\":" + (running_ ? "true" : "false") + ",\"stage\":" + text_of(stage_) +
         ",\"share\":" + json_number(share_) + ",\"version\":" + std::to_string(version_) + "}";
}

std::optional<std::vector<std::string>> LiveSession::completions(const std::string& line) {
  const std::unique_lock lock(session_mutex_, std::try_to_lock);
  if (!lock) return std::nullopt;
  return session_.completions(line);
}

PackedBlock LiveSession::made(const std::string& whole_name) {
  Session::Core& core = session_.core();
  const bool is_before = whole_name.starts_with(before_prefix), has_before = has_mesh_before(core);
  if (is_before && !has_before) return {};
  const auto before = [&]() -> MeshBefore& {
    if (!before_) before_ = mesh_before(core);
    return *before_;
  };
  const std::string name(without_prefix(whole_name));
  SceneSource source = is_before ? before().source(title_) : SceneSource{core.selector(), core.state, title_};
  if (!is_before && has_before) source.before = [&]() -> const Mesh& { return before().mesh(); };
  if (name == "cad") return cad_block(source);
  if (name == "inside") return inside_block(source);
  if (name == "sets") return sets_block(source);
  const std::vector<Channel> all = channels(source);
  if (name == "skin")
    return skin_block(source, scene_meta(source, all, {.shows_cad = source.selector.meshed.mesh.n_hexes() == 0}, {}));
  if (name.starts_with('c') && name.size() < 9 && name.find_first_not_of("0123456789", 1) == std::string::npos &&
      name.size() > 1) {
    const auto i = static_cast<std::size_t>(std::stol(name.substr(1)));
    if (i < all.size()) return channel_block(source, all[i]);
  }
  return {};
}

std::optional<LiveSession::Sent> LiveSession::block(const std::string& name, std::size_t have) {
  const std::unique_lock lock(session_mutex_, std::try_to_lock);
  if (!lock) return std::nullopt;
  if (session_.meshed().mesh.n_hexes() == 0 && !session_.meshed().model) return Sent{.is_empty = true};
  PackedBlock now = made(name);
  if (now.arrays.empty() && now.name.empty()) return Sent{};
  auto& [number, before] = sent_[name];
  Sent result;
  result.is_difference = have != 0 && have == number;
  result.bytes = deflated(result.is_difference ? difference(before, now) : now);
  result.number = number = ++n_sent_;
  // Values are asked for one by one: they are not kept.
  const std::string_view kind = without_prefix(name);
  if (kind.starts_with('c') && kind != "cad")
    sent_.erase(name);
  else
    before = std::move(now);
  return result;
}

}  // namespace hextwist::app
