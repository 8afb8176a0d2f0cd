// The program at a terminal: prompt, completion, history, the caret of an error, Ctrl-C.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "session/session_fixture.h"

namespace hextwist {

using test::folder;

namespace {

/// The program in a terminal of its own.
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Terminal {
 public:
  Terminal() {
    const std::string home = folder().string();
    child_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (child_ == 0) {
      setenv("XDG_STATE_HOME", home.c_str(), 1);
      setenv("TERM", "dumb", 1);
      execl(HEXTWIST_PROGRAM, "hextwist", static_cast<char*>(nullptr));
      _exit(127);
    }
  }
  ~Terminal() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(terminal_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& text) {
    seen_.clear();
    EXPECT_EQ(write(terminal_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// What came since the last type(), up to this text; fails when it does not come.
  std::string until(const std::string& text) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (seen_.find(text) == std::string::npos && std::chrono::steady_clock::now() < end) {
      pollfd waiting{terminal_, POLLIN, 0};
      std::array<char, 4096> buffer;
      if (poll(&waiting, 1, 100) <= 0) continue;
      const ssize_t n = read(terminal_, buffer.data(), buffer.size());
      if (n <= 0) break;
      seen_.append(buffer.data(), static_cast<std::size_t>(n));
    }
    EXPECT_NE(seen_.find(text), std::string::npos) << "no '" << text << "' in:\n" << seen_;
    return seen_;
  }
  std::string answer(const std::string& line) {
    type(line + "\n");
    until("\n");
    return until("hextwist> ");
  }
  int end() {
    int status = -1;
    waitpid(std::exchange(child_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t child_ = -1;
  int terminal_ = -1;
  std::string seen_;
};

TEST(Interactive, completes_words_and_names_shows_the_caret_and_keeps_history) {
  Terminal terminal;
  terminal.until("hextwist> ");
  terminal.answer("create brick x 1 interval 2; block 1 name 'steel'; nodeset 2 node 1 2 name 'soft rubber'");
  EXPECT_PRED2(has, terminal.answer("li\tblock st\t"), "block 1 'steel': 8 hexes");
  EXPECT_PRED2(has, terminal.answer("list nodeset \"so\t"), "nodeset 2 'soft rubber': 2 nodes");
  EXPECT_PRED2(has, terminal.answer("refine crve 3"), "  refine crve 3\r\n         ^~~~");
  EXPECT_PRED2(has, terminal.answer("help smooth"), "smooth volume all");
  terminal.type("quit\n");
  EXPECT_EQ(terminal.end(), 0);
  std::ifstream history(folder() / "hextwist" / "history");
  const std::string lines{std::istreambuf_iterator<char>(history), {}};
  EXPECT_NE(lines.find("refine crve 3\n"), std::string::npos) << lines;
  EXPECT_NE(lines.find("list block steel"), std::string::npos) << lines;
}

TEST(Interactive, knows_its_history_and_where_it_is) {
  Terminal terminal;
  terminal.until("hextwist> ");
  const std::string here = folder().string();
  std::filesystem::create_directories(folder() / "parts");
  std::ofstream(folder() / "parts" / "a part.msh") << "x";
  EXPECT_PRED2(has, terminal.answer("cd " + here), here);
  EXPECT_PRED2(has, terminal.answer("ls"), "  parts/");
  EXPECT_PRED2(has, terminal.answer("ls parts"), "  a part.msh");
  terminal.answer("cd parts");
  EXPECT_PRED2(has, terminal.answer("pwd"), here + "/parts");
  EXPECT_PRED2(has, terminal.answer("cd \"nowhere\""), "error: nowhere: No such file or directory");
  terminal.answer("create brick x 1 interval 2");
  EXPECT_PRED2(has, terminal.answer("!!"), "create brick x 1 interval 2");
  EXPECT_PRED2(has, terminal.answer("!cre"), "takes the place of the mesh of 8 hexes");
  EXPECT_PRED2(has, terminal.answer("history"), "  pwd");
  EXPECT_PRED2(has, terminal.answer("!nosuch"), "no such line in the history");
  EXPECT_PRED2(has, terminal.answer("list hex 7 to \t"), "hex 8");
  terminal.type("{loop(2)}\n");
  terminal.until("        > ");
  terminal.type("list hex 1\n");
  terminal.until("        > ");
  EXPECT_PRED2(has, terminal.answer("{endloop}"), "hex 1");
  terminal.type("quit\n");
  EXPECT_EQ(terminal.end(), 0);
}

TEST(Interactive, control_c_cancels_the_running_command_and_leaves_the_session_as_it_was) {
  Terminal terminal;
  terminal.until("hextwist> ");
  terminal.answer("create sphere radius 1 interval 3; nodeset 1 node 1");
  const std::string before = terminal.answer("list");
  terminal.type("refine surface all numsplit 3 depth 1 smooth\n");
  terminal.until("smooth\r\n");  // the line has been read: now it runs
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  terminal.type("\x03");
  terminal.until("error: cancelled");
  terminal.until("hextwist> ");
  EXPECT_EQ(terminal.answer("list"), before);
  // At the prompt it clears the line.
  terminal.type("refine hex 1\x03");
  terminal.until("hextwist> ");
  EXPECT_EQ(terminal.answer("list"), before);
  terminal.type("quit\n");
  EXPECT_EQ(terminal.end(), 0);
}

}  // namespace
}  // namespace hextwist
