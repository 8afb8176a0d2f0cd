// Names of groups in formats that know groups by their names: no two alike, and what is changed is told.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hextwist::io {

/// As much of a text as there is room for, without a piece of a letter that has several characters (UTF-8).
std::string_view first_letters(std::string_view text, std::size_t longest);

/// The name of a group in a file: `fitted` (what the format can have of `name`), with "_id" behind it where it is in
/// `taken` or is what unnamed groups are called ("block_5", generated_id() in listing.h), as much of it as there is
/// room for; that of an unnamed group where `fitted` is empty. It is taken then. Tells where it is not `name`. longest:
/// characters.
std::string distinct_name(const char* kind, int id, const std::string& name, std::string fitted, std::size_t longest,
                          std::set<std::string>& taken, std::vector<std::string>& notices);

/// Ids that groups of one kind get where a file has names alone: those called as unnamed ones their own; then the
/// others what they wish, or one above all where that is taken or negative.
std::vector<int> ids_by_name(std::string_view kind, std::span<const std::string> names, std::span<const int> wishes);

/// Groups that come back with another id than they have, for one line in the end.
class NewIds {
 public:
  void add(const char* kind, int id, const std::string& name, int when_read);
  void tell(const char* format, std::vector<std::string>& notices) const;

 private:
  std::vector<std::string> changed_;
};

}  // namespace hextwist::io
