#include "describe/described.h"

#include <CLI/CLI.hpp>

#include "mpi/options.h"
#include "options.h"

namespace hextwist::app {
namespace {

/// Of "{a,b}", as CLI11 describes a set.
std::vector<std::string> words_of(const std::string& text) {
  const auto open = text.find('{'), close = text.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(text.substr(open + 1, close - open - 1), ',');
}

DescribedMode described(const std::string& word, const CLI::App& app) {
  DescribedMode mode{word, app.get_description(), {}};
  for (const CLI::Option* option : app.get_options()) {
    DescribedOption& made = mode.options.emplace_back();
    made.is_positional = option->get_positional();
    if (made.is_positional) {
      made.names = {option->get_single_name()};
    } else {
      for (const std::string& name : option->get_snames()) made.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) made.names.push_back("--" + name);
    }
    made.help = option->get_description();
    made.is_required = option->get_required();
    made.is_many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
    if (option->get_expected_max() > 0) {
      const std::string type = option->get_type_name();  // with what is checked, "INT:INT in [0 - 9]"
      made.value = type.substr(type.find(':') + 1);
      made.words = words_of(type);
      made.is_file = made.value == "TEXT";
      if (made.is_file) made.value = "FILE";
      if (!made.words.empty()) made.value = CLI::detail::join(made.words, "|");
    }
  }
  return mode;
}

}  // namespace

std::vector<DescribedMode> describe_program() {
  std::vector<DescribedMode> modes;
  std::vector<std::string> words = mode_words();
  words.insert(words.begin(), "");
  for (std::string word : words) {
    Options options;
    options.describe = [&](const CLI::App& app) { modes.push_back(described(word, app)); };
    char name[] = "hextwist";
    char* arguments[] = {name, word.data(), nullptr};
    read_options(word.empty() ? 1 : 2, arguments, options);
  }
  return modes;
}

DescribedMode describe_mpi() {
  DescribedMode mode;
  MpiOptions options;
  options.describe = [&](const CLI::App& app) { mode = described("", app); };
  char name[] = "hextwist-mpi";
  char* arguments[] = {name, nullptr};
  read_mpi_options(1, arguments, true, options);
  return mode;
}

}  // namespace hextwist::app
