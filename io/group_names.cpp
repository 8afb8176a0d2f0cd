#include "hextwist/io/group_names.h"

#include <algorithm>
#include <limits>

#include "hextwist/base/text.h"
#include "hextwist/io/listing.h"

namespace hextwist::io {

std::string_view first_letters(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t n = longest;
  while (n > 0 && (static_cast<unsigned char>(text[n]) & 0xC0) == 0x80) --n;  // in a letter
  // Text of another code has no such beginnings.
  return text.substr(0, longest - n < 4 ? n : longest);
}

std::string distinct_name(const char* kind, int id, const std::string& name, std::string fitted, std::size_t longest,
                          std::set<std::string>& taken, std::vector<std::string>& notices) {
  if (const auto whole = trimmed(name); whole.starts_with(fitted)) fitted = first_letters(whole, fitted.size());
  const std::string usual = std::string(kind) + "_" + std::to_string(id);
  const std::string stem = fitted.empty() ? usual : std::move(fitted);
  const auto fits = [&](const std::string& wanted) {
    return !taken.contains(wanted) && (name.empty() || generated_id(wanted, kind) < 0);
  };
  std::string result = std::string(first_letters(stem, longest));
  for (int k = 0; !fits(result); ++k) {
    const std::string tail = "_" + std::to_string(id) + (k == 0 ? "" : "_" + std::to_string(k));
    result = std::string(first_letters(stem, longest - std::min(longest, tail.size()))) + tail;
  }
  taken.insert(result);
  if (name.empty() && result != stem)
    notices.push_back(std::string(kind) + " " + std::to_string(id) + " is called '" + result + "' in the file");
  say_renamed(std::string(kind) + " " + std::to_string(id), name, result, notices);
  return result;
}

std::vector<int> ids_by_name(std::string_view kind, std::span<const std::string> names, std::span<const int> wishes) {
  std::vector<int> ids(names.size(), -1);
  std::set<int> taken;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const int own = generated_id(names[i], kind); own >= 0 && taken.insert(own).second) ids[i] = own;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (ids[i] >= 0) continue;
    int id = wishes[i];
    if (id < 0 || taken.contains(id)) {
      id = taken.empty() ? 1 : *taken.rbegin();
      if (!taken.empty()) id = id < std::numeric_limits<int>::max() ? id + 1 : 1;
      while (taken.contains(id)) ++id;
    }
    taken.insert(ids[i] = id);
  }
  return ids;
}

void NewIds::add(const char* kind, int id, const std::string& name, int when_read) {
  if (id != when_read)
    changed_.push_back(std::string(kind) + " " + std::to_string(id) + (name.empty() ? "" : " '" + name + "'") +
                       " becomes " + std::to_string(when_read));
}

void NewIds::tell(const char* format, std::vector<std::string>& notices) const {
  if (changed_.empty()) return;
  notices.push_back(std::string(format) +
                    " has names of groups, no ids, which are counted when it is read: " + joined(changed_, ", "));
}

}  // namespace hextwist::io
