#include "prototypes.h"

#include <algorithm>
#include <regex>

namespace hextwist::test {
namespace {

/// Comments, text in quotes and lines for the preprocessor become blanks or "".
std::string code_of(const std::string& text) {
  std::string code;
  const auto skip_to = [&](std::size_t at, const char* end) { return std::min(text.find(end, at), text.size()); };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool line_starts =
        code.find_last_not_of(" \t") == std::string::npos || code[code.find_last_not_of(" \t")] == '\n';
    if (text.compare(i, 2, "//") == 0) {
      i = skip_to(i, "\n") - 1;
    } else if (text.compare(i, 2, "/*") == 0) {
      i = skip_to(i, "*/") + 1;
    } else if (text[i] == '#' && line_starts) {
      do i = skip_to(i + 1, "\n");
      while (i < text.size() && text[i - 1] == '\\');
      --i;
    } else if (text.compare(i, 2, "R\"") == 0) {
      const std::size_t open = skip_to(i, "(");
      const std::string end = ")" + text.substr(i + 2, open - i - 2) + "\"";
      i = skip_to(open, end.c_str()) + end.size() - 1;
      code += "\"\"";
    } else if (text[i] == '"' ||
               (text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))) {
      const char quote = text[i];
      while (++i < text.size() && text[i] != quote) i += text[i] == '\\';
      code += "\"\"";
    } else {
      code += text[i];
    }
  }
  return code;
}

/// The commas between two places that are in no brackets.
int n_commas(const std::string& text) {
  int depth = 0, n = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (std::string("([{<").find(text[i]) != std::string::npos) ++depth;
    if (std::string(")]}>").find(text[i]) != std::string::npos) --depth;
    n += text[i] == ',' && depth == 0;
  }
  return n;
}

/// "name/arguments" of what stands before `;` or `{`, "" where that is no function.
std::string function_of(std::string statement) {
  static const std::regex other(
      "^\\s*(static_assert|catch|template|using|typedef|friend|static|inline|constexpr|consteval|struct|class|enum|"
      "union|extern\\s+template|return)\\b|\\boperator\\b");
  // Attributes such as [[nodiscard]] say nothing here.
  statement = std::regex_replace(statement, std::regex("\\[\\[[^\\]]*\\]\\]"), "");
  static const std::regex shape("^\\s*[\\w:<>,\\s*&()]*?[\\s*&>]((?:\\w+::)*\\w+)\\s*\\(");
  const auto open = statement.find('(');
  if (open == std::string::npos || statement.find('=') < open || std::regex_search(statement, other)) return "";
  std::smatch match;
  const std::string head = statement.substr(0, open + 1);
  if (!std::regex_match(head, match, shape)) return "";
  int depth = 0;
  std::size_t close = open;
  for (; close < statement.size(); ++close) {
    depth += (statement[close] == '(') - (statement[close] == ')');
    if (depth == 0) break;
  }
  if (close == statement.size()) return "";
  const std::string arguments = statement.substr(open + 1, close - open - 1);
  const bool none = arguments.find_first_not_of(" \n\t") == std::string::npos || arguments == "void";
  return match[1].str() + "/" + std::to_string(none ? 0 : n_commas(arguments) + 1);
}

}  // namespace

std::vector<FunctionSeen> functions_in(std::string text) {
  text = code_of(text);
  static const std::regex scope(
      "\\bnamespace\\s*(\\[\\[.*?\\]\\]|HEXTWIST_API)?\\s*([\\w:]*)\\s*$|\\bextern\\s*\"\"\\s*$");
  std::vector<FunctionSeen> seen;
  std::vector<std::string> scopes;  // names, "?" for one without
  std::string statement;
  const auto see = [&](bool is_body) {
    const std::string name = function_of(statement);
    if (name.empty() || std::ranges::count(scopes, "?")) return;
    std::string prefix;
    for (const auto& each : scopes)
      if (!each.empty()) prefix += each + "::";
    seen.push_back({prefix + name, is_body});
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::smatch match;
    if (text[i] == ';') {
      see(false);
      statement.clear();
    } else if (text[i] == '}') {
      if (!scopes.empty()) scopes.pop_back();
      statement.clear();
    } else if (text[i] != '{') {
      statement += text[i];
    } else if (std::regex_search(statement, match, scope)) {
      const bool is_namespace = match[0].str().starts_with("namespace");
      scopes.push_back(!is_namespace ? "" : match[2].length() ? match[2].str() : "?");
      statement.clear();
    } else {
      // Braces are skipped whole: a body, members of a class, or a default value, behind which the statement goes on.
      const bool is_value =
          std::count(statement.begin(), statement.end(), '(') != std::count(statement.begin(), statement.end(), ')');
      if (!is_value) see(true);
      int depth = 1;
      while (depth > 0 && ++i < text.size()) depth += (text[i] == '{') - (text[i] == '}');
      statement = is_value ? statement + "{}" : "";
    }
  }
  return seen;
}

}  // namespace hextwist::test
