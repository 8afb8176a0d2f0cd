// Manual pages and completions say what the program's own help says, and the programs that read them can.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "support/grids.h"

namespace hextwist {
namespace {

const std::filesystem::path share = HEXTWIST_SHARE;

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The folder of this test, emptied when it starts.
const std::filesystem::path& folder() {
  static std::filesystem::path result;
  static const testing::TestInfo* of = nullptr;
  if (const auto* now = testing::UnitTest::GetInstance()->current_test_info(); now != of) {
    of = now;
    result = test::output_folder();
  }
  return result;
}

struct Outcome {
  int status;
  std::string out;
};
Outcome shell(const std::string& command) {
  const auto file = folder() / "said";
  const int status = std::system(("{ " + command + "; } > '" + file.string() + "' 2>&1").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(file)};
}
bool has(const char* program) {
  return shell(std::string("command -v ") + program).status == 0;
}
std::string program(const std::string& arguments) {
  return shell("'" HEXTWIST_PROGRAM "' " + arguments).out;
}

/// All first groups of matches.
std::set<std::string> all(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) found.insert((*at)[1]);
  return found;
}

/// Modes by the synopsis of the page, long options by the help of each.
std::set<std::string> modes() {
  return all(content(share / "man/man1/hextwist.1"), R"(\.B hextwist (\w+)\n)");
}
std::set<std::string> options(const std::string& mode) {
  static std::map<std::string, std::set<std::string>> known;
  if (!known.contains(mode)) known[mode] = all(program(mode + " --help"), R"((?:^|\n)  (?:-\w,)?(--[\w-]+))");
  return known[mode];
}
std::set<std::string> commands() {
  static std::set<std::string> names;
  if (names.empty()) names = all(program("-c help"), R"(\n  (\w+)  )");
  names.erase("help");
  return names;
}

TEST(Describe, the_pages_have_every_mode_option_and_command) {
  std::string page = content(share / "man/man1/hextwist.1");
  const std::string language = content(share / "man/man7/hextwist-commands.7");
  page = std::regex_replace(page, std::regex(R"(\\-)"), "-");
  const std::set<std::string> known = modes();
  EXPECT_TRUE(known.contains("check") && known.contains("convert") && known.contains("serve"));
  EXPECT_GT(commands().size(), 25u);
  for (const std::string& mode : known) {
    EXPECT_GT(options(mode).size(), 1u) << mode;
    for (const std::string& option : options(mode)) EXPECT_NE(page.find(option), std::string::npos) << mode << option;
  }
  EXPECT_GT(options("").size(), 6u);
  for (const std::string& option : options("")) EXPECT_NE(page.find(option), std::string::npos) << option;
  for (const std::string& command : commands()) {
    EXPECT_NE(page.find(".B " + command + "\n"), std::string::npos) << command;
    EXPECT_NE(language.find(".SH " + command + "\n"), std::string::npos) << command;
  }
}

TEST(Describe, man_reads_the_pages) {
  if (!has("mandoc")) GTEST_SKIP() << "mandoc is not installed";
  for (const char* page : {"man1/hextwist.1", "man1/hextwist-mpi.1", "man7/hextwist-commands.7"}) {
    const Outcome lint = shell("mandoc -T lint -W error '" + (share / "man" / page).string() + "'");
    EXPECT_EQ(lint.status, 0) << lint.out;
  }
  // As it is seen, line by line: nothing was taken for a request.
  const std::string seen =
      shell("mandoc -T utf8 '" + (share / "man/man7/hextwist-commands.7").string() + "' | col -b").out;
  std::string every;
  for (const std::string& command : commands()) every += "help " + command + ";";
  const std::set<std::string> titles = all("\n" + program("-c '" + every + "'"), R"(\n(\w+: [^\n]+))");
  EXPECT_GE(titles.size(), commands().size());
  for (const std::string& title : titles) EXPECT_NE(seen.find(title), std::string::npos) << title;
}

/// What bash offers for the last of these words.
std::set<std::string> bash_offers(const std::string& words) {
  const std::string script = "source '" + (share / "bash-completion/completions/hextwist").string() +
                             "'; compopt() { :; }; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _hextwist; printf '%s\\n' \"${COMPREPLY[@]}\"";
  std::ofstream(folder() / "script.sh") << script;
  return all(shell("cd / && bash '" + (folder() / "script.sh").string() + "'").out, R"((\S+))");
}

TEST(Describe, bash_completes_modes_options_words_and_commands) {
  if (!has("bash")) GTEST_SKIP() << "bash is not installed";
  EXPECT_EQ(bash_offers("hextwist spl"), std::set<std::string>{"split"});
  EXPECT_EQ(bash_offers("hextwist split --by s"), (std::set<std::string>{"scotch", "slabs"}));
  for (const std::string& option : options("convert"))
    EXPECT_TRUE(bash_offers("hextwist convert " + option).contains(option)) << option;
  EXPECT_EQ(bash_offers("hextwist convert --keep"), std::set<std::string>{});
  for (const std::string& command : commands())
    EXPECT_TRUE(bash_offers("hextwist -c " + command).contains(command)) << command;
  EXPECT_TRUE(bash_offers("hextwist --cad et").contains("etc"));
}

TEST(Describe, fish_completes_the_same) {
  if (!has("fish")) GTEST_SKIP() << "fish is not installed";
  const auto offers = [](const std::string& line) {
    return shell("cd / && HOME=/nonexistent fish --no-config -c 'source \"" +
                 (share / "fish/vendor_completions.d/hextwist.fish").string() + "\"; complete -C \"" + line + "\"'")
        .out;
  };
  EXPECT_TRUE(offers("hextwist spl").starts_with("split")) << offers("hextwist spl");
  EXPECT_NE(offers("hextwist split --b").find("--by"), std::string::npos);
  EXPECT_EQ(offers("hextwist convert --keep"), "");
  EXPECT_NE(offers("hextwist -c ref").find("refine"), std::string::npos);
}

TEST(Describe, zsh_reads_its_file) {
  if (!has("zsh")) GTEST_SKIP() << "zsh is not installed";
  const auto file = share / "zsh/vendor-completions/_hextwist";
  const Outcome read = shell("zsh -n '" + file.string() + "'");
  EXPECT_EQ(read.status, 0) << read.out;
  const std::string text = content(file);
  EXPECT_TRUE(text.starts_with("#compdef hextwist\n"));
  for (const std::string& option : options("")) EXPECT_NE(text.find(option + "["), std::string::npos) << option;
  for (const std::string& mode : modes()) EXPECT_NE(text.find("    " + mode + ")\n"), std::string::npos) << mode;
}

}  // namespace
}  // namespace hextwist
