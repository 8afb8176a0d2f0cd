// Functions of C++ text at namespace scope, found by their shape alone.
#pragma once

#include <string>
#include <vector>

namespace hextwist::test {

/// name: with namespaces, and the number of arguments behind a slash: "hextwist::volume/2". is_body: else a prototype.
struct FunctionSeen {
  std::string name;
  bool is_body = false;
  bool operator==(const FunctionSeen&) const = default;
};

/// Functions declared or defined in a file, in its order. Left out: members of classes, templates, what is inline,
/// constexpr or static, and anonymous namespaces.
std::vector<FunctionSeen> functions_in(std::string text);

}  // namespace hextwist::test
