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

#include "hextwist/base/memory.h"
#include "hextwist/command/flow.h"
#include "hextwist/command/syntax.h"

namespace hextwist::app {
namespace {

constexpr int most_lines = 2000;

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

/// May a file name stand at the end of the line?
bool takes_file(const std::string& line) {
  const std::vector<std::string> what = expected_at_end(line).what;
  return line.starts_with("cd ") || line.starts_with("ls ") ||
         std::ranges::find(what, "a file name in quotes") != what.end();
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
    if (offered.empty() && takes_file(line)) return nullptr;
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

/// What follows a word on the line, blanks and quotes around it taken off.
std::string behind(const std::string& line, std::string_view word) {
  std::string rest = line.substr(std::min(line.size(), word.size()));
  const auto first = rest.find_first_not_of(" \t\"'");
  if (first == std::string::npos) return "";
  return rest.substr(first, rest.find_last_not_of(" \t\"'") - first + 1);
}

/// Lines for the prompt alone, which no journal has: where the program is, and what was typed. False: none of these.
bool run_here(const std::string& line) {
  const std::string word = line.substr(0, line.find_first_of(" \t"));
  if (word == "history") {
    for (int i = 0; i < ::history_length; ++i)
      if (const HIST_ENTRY* entry = history_get(history_base + i))
        std::cout << "  " << history_base + i << "  " << entry->line << "\n";
  } else if (word == "pwd") {
    std::cout << std::filesystem::current_path().string() << "\n";
  } else if (word == "cd") {
    const char* home = std::getenv("HOME");
    const std::string folder = behind(line, word);
    const std::string to = folder.empty() && home ? home : folder;
    std::error_code failed;
    std::filesystem::current_path(to, failed);
    if (failed) throw std::filesystem::filesystem_error("", to, failed);
    std::cout << std::filesystem::current_path().string() << "\n";
  } else if (word == "ls") {
    const std::string folder = behind(line, word);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder))
      names.push_back(entry.path().filename().string() + (entry.is_directory() ? "/" : ""));
    std::ranges::sort(names);
    for (const std::string& name : names)
      if (!name.starts_with('.')) std::cout << "  " << name << "\n";
  } else {
    return false;
  }
  std::cout << std::flush;
  return true;
}

/// !! and !3 are lines of the history; shows what they stand for. False: there is no such line.
bool expand_history(std::string& text) {
  if (!text.starts_with('!')) return true;
  char* expanded = nullptr;
  const int result = history_expand(text.data(), &expanded);
  const std::unique_ptr<char, decltype(&std::free)> owned(expanded, &std::free);
  if (result < 0 || result == 2) return false;
  text = expanded;
  std::cout << text << "\n" << std::flush;
  return true;
}

/// One command, continued lines joined; false at the end of input.
bool read_command(std::string& text) {
  text.clear();
  do {
    return_freed_memory();
    const std::unique_ptr<char, decltype(&std::free)> line(readline(text.empty() ? "hextwist> " : "        > "),
                                                           &std::free);
    if (!line) return !text.empty();
    if (!text.empty()) text += '\n';
    text += line.get();
    if (!expand_history(text)) {
      std::cerr << "error: there is no such line in the history\n";
      text.clear();
      return true;
    }
    const std::string last = text.substr(text.rfind('\n') + 1);
    if (last.find_first_not_of(" \t") != std::string::npos) add_history(last.c_str());
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
  stifle_history(most_lines);
  if (!history.empty()) read_history(history.c_str());
  std::cout << "hextwist " HEXTWIST_VERSION ". 'help' lists the commands, 'quit' ends, Tab completes.\n" << std::flush;
  std::string text;
  while (!session.finished() && read_command(text) && !ending_signal()) {
    take_interrupt();
    try {
      if (!run_here(text)) session.run(text);
    } catch (const Error& error) {
      console.error(error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      console.error(error.path1().string() + ": " + error.code().message());
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
