#include "hextwist/io/medit/references_internal.h"

#include <set>

#include "hextwist/base/sorted.h"

namespace hextwist::io {

std::vector<int> write_references(Output& out, const ReferenceKinds& kinds, const Classes& classes,
                                  std::span<const NamedGroup> groups, std::vector<std::string>& notices) {
  // A class that is a whole group, or a whole entity where there are no groups, has that id; the rest get new ones.
  std::vector<int> n_classes(groups.size(), 0);
  std::map<int, int> n_of_entity;
  for (std::size_t c = 0; c < classes.key.size(); ++c) {
    for (const int g : classes.groups[c]) ++n_classes[g];
    ++n_of_entity[classes.key[c]];
  }
  int next = 1;
  for (const NamedGroup& group : groups) next = std::max(next, group.id + 1);
  for (const int key : classes.key) next = std::max(next, key + 1);
  std::vector<int> reference(classes.key.size(), 0);
  std::map<int, std::vector<int>> of_entity;
  std::vector<std::vector<int>> of_group(groups.size());
  for (std::size_t c = 0; c < reference.size(); ++c) {
    const auto& in = classes.groups[c];
    if (in.empty() && classes.key[c] <= 0) continue;
    // 0 says that an element is in nothing.
    if (in.size() == 1 && n_classes[in[0]] == 1 && groups[in[0]].id > 0)
      reference[c] = groups[in[0]].id;
    else if (in.empty() && groups.empty())
      reference[c] = classes.key[c];
    else
      reference[c] = next++;
    if (classes.key[c] > 0) of_entity[classes.key[c]].push_back(reference[c]);
    for (const int g : in) of_group[g].push_back(reference[c]);
  }
  const auto comment = [&](const char* kind, int id, const std::vector<int>& references, const std::string& name) {
    const std::string plain = one_line(name);
    say_renamed(std::string(kind) + " " + std::to_string(id), name, plain, notices);
    out << "# hextwist " << kind << ' ' << id << ' ' << references.size();
    for (const int r : references) out << ' ' << r;
    out << ' ' << plain << '\n';
  };
  std::string others;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (of_group[g].size() == 1 && of_group[g][0] == groups[g].id) continue;
    others += (others.empty() ? "" : "; ") + std::to_string(groups[g].id) + " is";
    for (const int r : of_group[g]) others += " " + std::to_string(r);
    if (of_group[g].empty()) others += " empty";
  }
  if (!others.empty())
    notices.push_back(std::string("groups overlap, and MEDIT has one reference of each element, so that a ") +
                      kinds.group + " has others: " + others);
  if (std::ranges::any_of(groups, [](const NamedGroup& group) { return !group.name.empty(); }))
    notices.push_back(std::string("MEDIT has no names: those of ") + kinds.group + "s are in comments");
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (!of_entity.empty() || !groups[g].name.empty() || of_group[g] != std::vector{groups[g].id})
      comment(kinds.group, groups[g].id, of_group[g], groups[g].name);
  for (const auto& [id, references] : of_entity) comment(kinds.entity, id, references, "");
  return reference;
}

void ReferenceComments::add(std::string_view comment, const Cursor& cursor) {
  constexpr std::string_view mark = " hextwist ";
  if (!comment.starts_with(mark)) return;
  ours = true;
  Cursor words(comment.substr(mark.size()), cursor.name);
  const std::string kind(words.word());
  if (kind == "mesh") return;
  const int id = words.small("an id");
  if (id < 0) cursor.fail(kind + " id " + std::to_string(id) + " is negative");
  Entry& entry = entries[kind][id];
  entry.references.resize(words.check_count(words.integer("a number of references"), 2, "references"));
  for (int& reference : entry.references) reference = words.small("a reference");
  if (words.at < words.end) ++words.at;
  entry.name = std::string(words.at, words.end);
}

std::map<int, ReferenceComments::Entry> ReferenceComments::groups(const ReferenceKinds& kinds,
                                                                  std::vector<int> references) const {
  std::map<int, Entry> result;
  std::set<int> explained;
  for (const char* kind : {kinds.group, kinds.entity})
    if (const auto found = entries.find(kind); found != entries.end()) {
      for (const auto& [id, entry] : found->second) explained.insert(entry.references.begin(), entry.references.end());
      if (kind == kinds.group) result = found->second;
    }
  sort_unique(references);
  for (const int reference : references)
    if (reference > 0 && !explained.contains(reference)) result[reference].references = {reference};
  return result;
}

std::map<int, int> ReferenceComments::entities(const ReferenceKinds& kinds) const {
  std::map<int, int> result;
  if (const auto found = entries.find(kinds.entity); found != entries.end())
    for (const auto& [id, entry] : found->second)
      for (const int reference : entry.references) result[reference] = id;
  return result;
}

}  // namespace hextwist::io
