#include <algorithm>

#include "describe/described.h"
#include "describe/write.h"
#include "hextwist/command/syntax.h"

namespace hextwist::app {
namespace {

/// In single quotes, for a shell.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : between) + word;
  return result;
}

/// First words of commands, for -c.
std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const CommandSpec& command : language())
    if (!command.syntax.empty()) names.emplace_back(command.name);
  return names;
}

bool takes_commands(const DescribedOption& option) {
  return option.value == "COMMANDS";
}

/// The first sentence or line, for a list.
std::string brief(const std::string& help) {
  return help.substr(0, std::min({help.find('\n'), help.find(". "), help.size()}));
}

const std::string written = "# Written by the build, from what the program reads.\n";

}  // namespace

std::string bash_completion() {
  const std::vector<DescribedMode> modes = describe_program();
  std::string text = written +
                     "_hextwist() {\n  local cur prev\n  cur=${COMP_WORDS[COMP_CWORD]}\n"
                     "  prev=${COMP_WORDS[COMP_CWORD-1]}\n  local options words\n  case ${COMP_WORDS[1]} in\n";
  std::vector<std::string> words;
  const auto one = [&](const DescribedMode& mode) {
    std::vector<std::string> names;
    std::string values;
    for (const DescribedOption& option : mode.options) {
      if (option.is_positional) continue;
      names.insert(names.end(), option.names.begin(), option.names.end());
      if (option.value.empty()) continue;
      const std::vector<std::string> choices = takes_commands(option) ? command_names() : option.words;
      values += "        " + joined(option.names, "|") + ") ";
      if (!choices.empty())
        values += "COMPREPLY=($(compgen -W " + quoted(joined(choices, " ")) + " -- \"$cur\"))";
      else
        values += option.is_file ? "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$cur\"))" : "COMPREPLY=()";
      values += "; return ;;\n";
    }
    text += "    " + (mode.word.empty() ? "*" : mode.word) + ")\n      options=" + quoted(joined(names, " ")) +
            "\n      case $prev in\n" + values + "      esac ;;\n";
  };
  for (auto mode = modes.begin() + 1; mode != modes.end(); ++mode) {
    words.push_back(mode->word);
    one(*mode);
  }
  one(modes.front());
  return text + "  esac\n  [ \"$COMP_CWORD\" = 1 ] && words=" + quoted(joined(words, " ")) +
         "\n  compopt -o filenames\n"
         "  if [[ $cur == -* ]]; then\n    COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n"
         "  else\n    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\") $(compgen -f -- \"$cur\"))\n  fi\n}\n"
         "complete -F _hextwist hextwist\n";
}

std::string zsh_completion() {
  const std::vector<DescribedMode> modes = describe_program();
  std::string text = "#compdef hextwist\n" + written;
  std::string words, cases;
  // A colon and brackets have a meaning in a specification of _arguments.
  const auto escaped = [](const std::string& help) {
    std::string result;
    for (const char c : help)
      result += c == '[' || c == ']' || c == ':' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return result;
  };
  for (const DescribedMode& mode : modes) {
    std::string specs;
    for (const DescribedOption& option : mode.options) {
      if (option.is_positional) continue;
      std::string value;
      if (!option.value.empty()) {
        const std::vector<std::string> choices = takes_commands(option) ? command_names() : option.words;
        value = ":" + escaped(option.value) + ":";
        if (!choices.empty())
          value += "(" + joined(choices, " ") + ")";
        else
          value += option.is_file ? "_files" : " ";
      }
      for (const std::string& name : option.names)
        specs += " \\\n        " +
                 quoted((takes_commands(option) ? "*" : "") + name + "[" + escaped(brief(option.help)) + "]" + value);
    }
    if (!mode.word.empty()) words += "    " + quoted(mode.word + ":" + brief(mode.help)) + "\n";
    // The word itself is the first that stands by itself.
    cases += "    " + (mode.word.empty() ? "*" : mode.word) + ")\n      _arguments" + specs +
             " \\\n        '*:file:" + (mode.word.empty() ? "_hextwist_first" : "_files") + "' ;;\n";
  }
  // The usual way last, for it takes whatever comes.
  const auto second = cases.find(" ;;\n") + 4;
  return text + "_hextwist_first() {\n  local -a words_of_hextwist=(\n" + words +
         "  )\n  ((CURRENT == 2)) && _describe 'what to do' words_of_hextwist\n  _files\n}\n"
         "_hextwist() {\n  case $words[2] in\n" +
         cases.substr(second) + cases.substr(0, second) + "  esac\n}\n_hextwist \"$@\"\n";
}

std::string fish_completion() {
  std::string text = written;
  std::vector<std::string> words;
  const std::vector<DescribedMode> modes = describe_program();
  for (const DescribedMode& mode : modes)
    if (!mode.word.empty()) words.push_back(mode.word);
  const std::string in_none = "not __fish_seen_subcommand_from " + joined(words, " ");
  for (const DescribedMode& mode : modes) {
    const std::string when = mode.word.empty() ? in_none : "__fish_seen_subcommand_from " + mode.word;
    if (!mode.word.empty())
      text += "complete -c hextwist -n __fish_is_first_arg -a " + mode.word + " -d " + quoted(brief(mode.help)) + "\n";
    for (const DescribedOption& option : mode.options) {
      if (option.is_positional) continue;
      text += "complete -c hextwist -n " + quoted(when);
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      const std::vector<std::string> choices = takes_commands(option) ? command_names() : option.words;
      if (!option.value.empty()) text += option.is_file ? " -r -F" : " -x";
      if (!choices.empty()) text += " -a " + quoted(joined(choices, " "));
      text += " -d " + quoted(brief(option.help)) + "\n";
    }
  }
  return text;
}

}  // namespace hextwist::app
