#include "interactive.h"

#include <readline/history.h>
#include <readline/readline.h>
#include <strings.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>

#include "hextwist/command/flow.h"
#include "hextwist/command/syntax.h"

namespace hextwist::app {
namespace {

constexpr int history_length = 2000;

/// Empty where there is no home.
std::filesystem::path history_file() {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path folder;
  if (state && *state)
    folder = state;
  else if (home && *home)
    folder = std::filesystem::path(home) / ".local" / "state";
  else
    return {};
  folder /= "hextwist";
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  return failed ? std::filesystem::path() : folder / "history";
}

Session* session_of_prompt = nullptr;  // readline's callbacks have no argument for it
std::vector<std::string> offered;

char* next_offer(const char*, int at) {
  static std::size_t next = 0;
  if (at == 0) next = 0;
  return next < offered.size() ? strdup(offered[next++].c_str()) : nullptr;
}

char** complete(const char* beginning, int start, int end) {
  const std::string line(rl_line_buffer, static_cast<std::size_t>(end));
  const char quote = start > 0 ? rl_line_buffer[start - 1] : ' ';
  const bool quoted = quote == '"' || quote == '\'';
  if (quoted) {
    // A name or a file: what could stand where the quote begins?
    const std::string before = line.substr(0, static_cast<std::size_t>(start) - 1) + " ";
    const std::vector<std::string> words = completions(before);
    offered = session_of_prompt->completions(before);
    std::erase_if(offered, [&](std::string& text) {
      const bool is_word = std::ranges::find(words, text) != words.end();
      if (text.front() == '"') text = text.substr(1, text.size() - 2);
      return is_word || strncasecmp(text.c_str(), beginning, std::strlen(beginning)) != 0;
    });
    if (offered.empty()) return nullptr;  // readline's own: file names
  } else {
    if (std::strpbrk(beginning, "./")) return nullptr;
    offered = session_of_prompt->completions(line);
  }
  rl_attempted_completion_over = 1;
  return rl_completion_matches(beginning, next_offer);
}

int on_signal() {
  if (ending_signal()) rl_done = 1;
  if (take_interrupt()) {
    std::cout << "\n" << std::flush;  // the terminal has shown the ^C
    rl_replace_line("", 0);
    rl_on_new_line();
    rl_redisplay();
  }
  return 0;
}

/// One command, continued lines joined; false at the end of input.
bool read_command(std::string& text) {
  text.clear();
  do {
    const std::unique_ptr<char, decltype(&std::free)> line(readline(text.empty() ? "hextwist> " : "        > "),
                                                           &std::free);
    if (!line) return !text.empty();
    if (!text.empty()) text += '\n';
    text += line.get();
    if (*line && std::strspn(line.get(), " \t") < std::strlen(line.get())) add_history(line.get());
  } while (wants_more(text) && !ending_signal());
  return true;
}

}  // namespace

void run_interactive(Session& session, Console& console) {
  rl_readline_name = "hextwist";
  rl_attempted_completion_function = complete;
  rl_completer_quote_characters = "\"'";
  rl_basic_word_break_characters = " \t\n;,\"'";
  rl_signal_event_hook = on_signal;
  rl_event_hook = on_signal;  // a signal that came while a key was being handled is seen soon after
  session_of_prompt = &session;
  const std::filesystem::path history = history_file();
  stifle_history(history_length);
  if (!history.empty()) read_history(history.c_str());
  std::cout << "hextwist " HEXTWIST_VERSION ". 'help' lists the commands, 'quit' ends.\n" << std::flush;
  std::string text;
  while (!session.finished() && read_command(text) && !ending_signal()) {
    take_interrupt();
    try {
      session.run(text);
    } catch (const Error& error) {
      console.error(error.what());
    }
    console.idle();
    // Now rather than at the end, which a second Ctrl-C may bring at once.
    if (!history.empty()) write_history(history.c_str());
  }
  if (!session.finished()) std::cout << "\n";
}

int run_standard_input(Session& session) {
  int n_failed = 0, line_number = 0;
  std::string line;
  while (!session.finished() && !ending_signal() && std::getline(std::cin, line)) {
    const int first = ++line_number;
    std::string text = line;
    while (wants_more(text) && std::getline(std::cin, line)) {
      text += "\n" + line;
      ++line_number;
    }
    n_failed += session.run(text, "stdin", first);
  }
  return n_failed;
}

}  // namespace hextwist::app
