// Abaqus .inp (Abaqus Keywords Guide; CalculiX and others write the same): keywords to AbaqusContents.
#include <Eigen/Geometry>
#include <limits>
#include <numbers>
#include <set>

#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return result;
}

const Bytes* AbaqusContents::source(const char* at) const {
  for (const auto& source : sources)
    if (at >= source->data.get() && at <= source->data.get() + source->size) return source.get();
  return nullptr;
}

std::string AbaqusContents::where(const char* at) const {
  const Bytes* in = source(at);
  return in ? Cursor(*in).where(at) : sources[0]->name;
}

void AbaqusContents::fail(const char* at, const std::string& what) const {
  throw Error(where(at) + ": " + what);
}

namespace {

class Parser {
 public:
  Parser(AbaqusContents& contents, std::filesystem::path only_below)
      : out_(contents), only_below_(std::move(only_below)) {
    out_.scopes.push_back(std::make_unique<AbaqusScope>());
    scope_ = out_.scopes[0].get();
  }

  void read(std::unique_ptr<Bytes> bytes) {
    if (out_.sources.size() > 100) throw Error(bytes->name + ": includes files without end");
    out_.sources.push_back(std::move(bytes));
    Cursor cursor(*out_.sources.back());
    while (cursor.more()) {
      if (*cursor.at != '*') {
        if (!begun_) cursor.fail("not an Abaqus file: expected a keyword, found " + shown(cursor.word()));
        cursor.line();
        continue;
      }
      if (cursor.left() > 1 && cursor.at[1] == '*') {
        const char* at = cursor.at;
        comment(cursor.line(), at);
        continue;
      }
      begun_ = true;
      keyword(cursor);
    }
    if (!cursor.last_line_ends())
      out_.notices.push_back(cursor.where(cursor.end) + ": the last line has no end; the file may be cut short");
  }
  void finish() {
    if (out_.announced[1] > 0 && !ended_)
      throw Error(out_.sources[0]->name + ": the file ends before '** hextwist end': it is cut short");
  }

 private:
  /// The parameters of a keyword line, names in upper case; lines that end with a comma go on.
  struct Keyword {
    std::string name;
    std::map<std::string, std::string> parameters;
    const char* at;
    const std::string* find(const std::string& parameter) const {
      const auto found = parameters.find(parameter);
      return found == parameters.end() ? nullptr : &found->second;
    }
  };

  Keyword split(Cursor& cursor) const {
    Keyword result;
    result.at = cursor.at;
    std::string text(trimmed(cursor.line()).substr(1));
    while (!text.empty() && text.back() == ',' && cursor.at < cursor.end && *cursor.at != '*')
      text += trimmed(cursor.line());
    std::string_view rest = text;
    for (bool first = true; !rest.empty() || first; first = false) {
      // A comma in quotes belongs to the name.
      std::size_t end = 0;
      for (bool quotes = false; end < rest.size() && (quotes || rest[end] != ','); ++end)
        if (rest[end] == '"') quotes = !quotes;
      const std::string_view item = trimmed(rest.substr(0, end));
      rest.remove_prefix(std::min(rest.size(), end + 1));
      const auto equals = item.find('=');
      if (first)
        result.name = upper_case(item);
      else if (!item.empty())
        result.parameters[upper_case(trimmed(item.substr(0, equals)))] =
            equals == std::string_view::npos ? "" : unquoted(trimmed(item.substr(equals + 1)));
      if (first && rest.empty()) break;
    }
    return result;
  }
  static std::string unquoted(std::string_view text) {
    std::string result(text);  // I."my set"
    std::erase(result, '"');
    return result;
  }
  const std::string& required(const Keyword& keyword, const std::string& parameter) const {
    const std::string* value = keyword.find(parameter);
    if (!value || value->empty()) out_.fail(keyword.at, "*" + keyword.name + " without " + parameter + "=");
    return *value;
  }

  void refuse_file(const Keyword& keyword) const {
    if (keyword.find("INPUT")) out_.fail(keyword.at, "*" + keyword.name + " with INPUT= is not supported");
  }

  /// Our own comments give sets their ids and real names: "** hextwist block 3 STEEL steel (hot)". The first announces
  /// "mesh <nodes> <hexes>", the last is "end".
  void comment(std::string_view line, const char* at) {
    constexpr std::string_view mark = "** hextwist ";
    if (!line.starts_with(mark)) return;
    out_.ours = true;
    line.remove_prefix(mark.size());
    std::array<std::string_view, 3> words;
    for (auto& word : words) {
      const auto end = std::min(line.find(' '), line.size());
      word = line.substr(0, end);
      line.remove_prefix(std::min(end + 1, line.size()));
    }
    if (words[0] == "end") ended_ = true;
    const auto first = number(words[1]);
    if (words[0] == "mesh") out_.announced = {first.value_or(0), number(words[2]).value_or(0)};
    if (words[0] != "block" && words[0] != "nodeset" && words[0] != "sideset" && words[0] != "faces") return;
    if (!first || *first < 0 || *first > std::numeric_limits<int>::max())
      out_.fail(at, std::string(words[0]) + " id " + shown(words[1]) + " is not between 0 and 2147483647");
    out_.real_names[{std::string(words[0]), upper_case(words[2])}] = {static_cast<int>(*first), std::string(line)};
  }

  AbaqusScope& open_scope(AbaqusScope::Kind kind, const Keyword& keyword, const std::string& name) {
    if (kind == AbaqusScope::assembly && out_.assembly) out_.fail(keyword.at, "a second *ASSEMBLY");
    for (const auto& other : out_.scopes)
      if (kind != AbaqusScope::assembly && other->kind == kind && same_word(other->name, name))
        out_.fail(keyword.at, "a second *" + keyword.name + " " + shown(name));
    scope_ = out_.scopes.emplace_back(std::make_unique<AbaqusScope>()).get();
    scope_->kind = kind;
    scope_->name = name;
    scope_->at = keyword.at;
    return *scope_;
  }
  void close_scope(bool instance) {
    scope_ = out_.scopes[0].get();
    for (const auto& scope : out_.scopes)
      if (instance && scope->kind == AbaqusScope::assembly) scope_ = scope.get();
  }

  void keyword(Cursor& cursor) {
    const Keyword keyword = split(cursor);
    const std::string& name = keyword.name;
    const std::string* given = keyword.find("NAME");
    if (name == "NODE")
      nodes(cursor, keyword);
    else if (name == "ELEMENT")
      elements(cursor, keyword);
    else if (name == "NSET" || name == "ELSET")
      set(cursor, keyword);
    else if (name == "SURFACE" && is_mesh_surface(keyword))
      surface(cursor, keyword);
    else if (name == "PART")
      open_scope(AbaqusScope::part, keyword, given ? *given : "");
    else if (name == "ASSEMBLY")
      out_.assembly = &open_scope(AbaqusScope::assembly, keyword, given ? *given : "");
    else if (name == "END PART" || name == "END ASSEMBLY" || name == "END INSTANCE")
      close_scope(name == "END INSTANCE");
    else if (name == "INSTANCE")
      instance(cursor, keyword);
    else if (name == "INCLUDE")
      include(keyword, cursor);
    else if (name == "HEADING")
      heading(cursor);
    else if (name == "NGEN" || name == "NFILL" || name == "NCOPY" || name == "ELGEN" || name == "ELCOPY" ||
             name == "SYSTEM" || name == "NMAP")
      out_.fail(keyword.at, "*" + name + " is not supported: nodes or elements would be missing or misplaced");
    else
      card(cursor, keyword);
  }

  /// All else is no mesh: kept as it stands, with its data lines.
  void card(Cursor& cursor, const Keyword& keyword) {
    AbaqusRawCard card{keyword.name, {}, {}, keyword.at};
    const char* from = keyword.at;
    const auto add = [&] {
      card.text.append(from, cursor.at);
      std::erase(card.text, '\r');
      if (!card.text.ends_with('\n')) card.text += '\n';
    };
    add();
    while (cursor.more_lines()) {  // an empty line is a data line
      from = cursor.at;
      if (*from == '*' && (cursor.left() < 2 || from[1] != '*')) break;
      if (const std::string_view line = cursor.line(); line.starts_with("**"))
        comment(line, from);
      else
        add();
    }
    if (depends_on_numbers(keyword.name)) {
      out_.notices.push_back(out_.where(keyword.at) + ": *" + keyword.name +
                             " is left out: it speaks of single nodes or elements");
      return;
    }
    if (const std::string what = what_does_not_follow(card); !what.empty())
      out_.notices.push_back(out_.where(keyword.at) + ": *" + keyword.name + " " + what);
    scope_->cards.push_back(std::move(card));
  }

  void heading(Cursor& cursor) {
    while (cursor.at < cursor.end && *cursor.at != '*')
      if (const std::string line(cursor.line()); !trimmed(line).empty()) out_.heading += line + "\n";
    if (out_.heading == "hextwist\n") out_.heading.clear();
  }

  /// Surfaces of other types (sections through the model, ...) are cards.
  static bool is_mesh_surface(const Keyword& keyword) {
    const std::string* type = keyword.find("TYPE");
    return !type || same_word(*type, "ELEMENT") || same_word(*type, "NODE");
  }

  /// At a data line: not at the end, a keyword or a comment (those are skipped).
  bool data_line(Cursor& cursor, bool& interrupted) {
    while (cursor.more()) {
      if (*cursor.at != '*') return true;
      if (cursor.left() < 2 || cursor.at[1] != '*') return false;
      const char* at = cursor.at;
      comment(cursor.line(), at);
      interrupted = true;
    }
    return false;
  }
  static void skip_inline(Cursor& cursor) {
    while (!line_ends(cursor) && Cursor::blank(*cursor.at)) ++cursor.at;
  }
  /// After a number: its comma, if there is one.
  static bool comma(Cursor& cursor) {
    skip_inline(cursor);
    if (cursor.at == cursor.end || *cursor.at != ',') return false;
    ++cursor.at;
    skip_inline(cursor);
    return true;
  }
  static bool line_ends(const Cursor& cursor) { return cursor.at == cursor.end || *cursor.at == '\n'; }

  void nodes(Cursor& cursor, const Keyword& keyword) {
    refuse_file(keyword);
    if (const std::string* system = keyword.find("SYSTEM"); system && upper_case(*system) != "R")
      out_.fail(keyword.at, "*NODE in a cylindrical or spherical system is not supported");
    AbaqusScope& to = *scope_;
    const std::size_t first = to.node_ids.size();
    bool new_run = true;
    const char* expected = nullptr;
    while (data_line(cursor, new_run)) {
      if (new_run || cursor.at != expected) to.node_runs.push_back({to.node_ids.size(), cursor.at});
      new_run = false;
      to.node_ids.push_back(cursor.integer("a node id"));
      Vec3& point = to.points.emplace_back(Vec3::Zero());
      bool more = comma(cursor);
      for (int axis = 0; axis < 3 && more && !line_ends(cursor); ++axis) {
        const char* at = cursor.at;
        if (*cursor.at != ',') point[axis] = cursor.real("a coordinate");
        if (!std::isfinite(point[axis]))
          cursor.fail_at(at, "a coordinate of node " + std::to_string(to.node_ids.back()) + " is not finite");
        more = comma(cursor);
      }
      if (!more && !line_ends(cursor)) cursor.fail("expected a comma, found " + shown(cursor.word()));
      if (!trimmed(cursor.line()).empty() && out_.n_normals++ == 0) out_.first_normal = to.node_ids.back();
      expected = cursor.at;
    }
    if (const std::string* set = keyword.find("NSET"))
      to.sets.push_back({.kind = AbaqusSet::nodes,
                         .name = *set,
                         .at = keyword.at,
                         .ids = {to.node_ids.begin() + static_cast<std::ptrdiff_t>(first), to.node_ids.end()}});
  }

  void elements(Cursor& cursor, const Keyword& keyword) {
    refuse_file(keyword);
    if (keyword.find("OFFSET")) out_.fail(keyword.at, "*ELEMENT with OFFSET= is not supported");
    const std::string type = upper_case(required(keyword, "TYPE"));
    const AbaqusElement element = abaqus_element(type);
    AbaqusScope& to = *scope_;
    std::vector<std::int64_t> ids;
    bool ignored = false;
    while (data_line(cursor, ignored)) {
      const char* at = cursor.at;
      const auto id = cursor.integer("an element id");
      if (element.kind == AbaqusElement::refused)
        cursor.fail_at(at, "element " + std::to_string(id) + " is of type " + type +
                               "; of solids, hexes of 8, 20 or 27 nodes and tetrahedra, pyramids and wedges of usual "
                               "numbers of nodes are accepted");
      const bool more = comma(cursor);
      if (element.kind != AbaqusElement::hex) {
        if (other_element(cursor, type, element, id, at, more)) ids.push_back(id);
        continue;
      }
      ids.push_back(id);
      hex_nodes(cursor, type, element.n_nodes, id, at, more);
    }
    if (const std::string* set = keyword.find("ELSET"))
      to.sets.push_back({.kind = AbaqusSet::elements, .name = *set, .at = keyword.at, .ids = ids});
    if (ids.empty()) return;
    const bool hexes = element.kind == AbaqusElement::hex;
    if (hexes) to.hex_types.emplace_back(to.hex_ids.size(), type);
    if (!hexes) to.other_types.emplace_back(to.other_ids.size(), type);
    auto& kept = hexes ? to.hex_ids : to.other_ids;
    kept.insert(kept.end(), ids.begin(), ids.end());
    if (element.kind == AbaqusElement::unknown && known_.insert(type).second)
      out_.notices.push_back(out_.where(keyword.at) + ": elements of type " + type +
                             " are kept by their nodes: whether they share edges with hexes is not known");
  }

  void hex_nodes(Cursor& cursor, const std::string& type, int n, std::int64_t id, const char* at, bool more) {
    AbaqusScope& to = *scope_;
    bool ignored = false;
    std::vector<std::int64_t> middles;
    for (int c = 0; c < n; ++c) {
      auto& nodes = c >= 8 ? middles : to.hex_nodes;
      // Many nodes go on in the next line, with or without a comma at the end of this one.
      if (!more && c >= 8 && line_ends(cursor)) more = data_line(cursor, ignored);
      if (!more)
        cursor.fail_at(
            at, "element " + std::to_string(id) + " has " + std::to_string(c) + " of " + std::to_string(n) + " nodes");
      if (line_ends(cursor)) data_line(cursor, ignored);  // goes on in the next line
      nodes.push_back(cursor.integer("a node"));
      more = comma(cursor);
    }
    to.hex_at.push_back(at);
    if (!middles.empty()) to.hex_middles.emplace_back(to.hex_at.size() - 1, std::move(middles));
    skip_inline(cursor);
    if (!line_ends(cursor)) cursor.fail("element " + std::to_string(id) + " has more nodes than a " + type);
  }

  /// Behind the id. False: it leaves a node out (one end of a connector may be the ground), and is dropped.
  bool other_element(Cursor& cursor, const std::string& type, const AbaqusElement& element, std::int64_t id,
                     const char* at, bool more) {
    AbaqusScope& to = *scope_;
    // A node more says how a beam is turned.
    const bool any = element.n_nodes == 0;
    const std::size_t least = static_cast<std::size_t>(element.n_nodes),
                      most = least + (element.shape == OtherShape::line ? 1 : 0);
    std::vector<AbaqusMember> words;
    bool ignored = false;
    for (;;) {
      if (more && line_ends(cursor) && (any || words.size() < least)) more = data_line(cursor, ignored);
      if (!more && words.size() < least && least >= 8 && line_ends(cursor)) more = data_line(cursor, ignored);
      if (!more || line_ends(cursor)) break;
      skip_inline(cursor);
      const char* start = cursor.at;
      while (!line_ends(cursor) && *cursor.at != ',') ++cursor.at;
      words.push_back({std::string(trimmed({start, static_cast<std::size_t>(cursor.at - start)})), start});
      more = comma(cursor);
    }
    // CalculiX has node 0 where a fluid comes in or goes out.
    const bool is_short = !any && words.size() < least,
               has_gap = std::ranges::any_of(
                   words, [](const auto&word) { return word.text.empty() || word.text == "0"; });
    const bool may_have_gap = element.shape == OtherShape::connector || type == "D";
    if (may_have_gap && (is_short || has_gap || words.empty())) {
      ++out_.n_dropped[type];
      return false;
    }
    if (is_short || has_gap)
      out_.fail(at, "element " + std::to_string(id) + " has " + std::to_string(words.size()) + " of " +
                        std::to_string(least) + " nodes");
    if (!any && words.size() > most)
      out_.fail(words[most].at, "element " + std::to_string(id) + " has more nodes than a " + type);
    to.other_at.push_back(at);
    to.other_first.push_back(to.other_nodes.size());
    for (const AbaqusMember& word : words) {
      const auto node = number(word.text);
      if (!node) to.named_nodes.emplace_back(to.other_nodes.size(), AbaqusMember{unquoted(word.text), word.at});
      to.other_nodes.push_back(node.value_or(0));
    }
    return true;
  }

  /// Words of a data line, separated by commas.
  template <class F>
  void each_word(Cursor& cursor, F&& f) {
    const char* at = cursor.at;
    std::string_view line = cursor.line();
    while (!line.empty()) {
      const auto end = std::min(line.find(','), line.size());
      const std::string_view word = trimmed(line.substr(0, end));
      f(word, at);
      at += end + 1;
      line.remove_prefix(std::min(end + 1, line.size()));
    }
  }
  static std::optional<std::int64_t> number(std::string_view word) {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size()) return {};
    return value;
  }

  void set(Cursor& cursor, const Keyword& keyword) {
    refuse_file(keyword);
    AbaqusSet set{.kind = keyword.name == "NSET" ? AbaqusSet::nodes : AbaqusSet::elements,
                  .name = required(keyword, keyword.name),
                  .at = keyword.at};
    if (const std::string* instance = keyword.find("INSTANCE")) set.instance = *instance;
    if (const std::string* elset = keyword.find("ELSET"); elset && set.kind == AbaqusSet::nodes) set.elset = *elset;
    const bool generate = keyword.find("GENERATE") != nullptr;
    bool ignored = false;
    while (data_line(cursor, ignored)) {
      const char* start = cursor.at;
      std::vector<std::int64_t> range;
      each_word(cursor, [&](std::string_view word, const char* at) {
        if (word.empty()) return;
        const auto id = number(word);
        if (generate && !id) out_.fail(at, "expected a number, found " + shown(word));
        if (generate)
          range.push_back(*id);
        else if (id)
          set.ids.push_back(*id);
        else
          set.members.push_back({unquoted(word), at});
      });
      if (!generate) continue;
      if (range.size() < 2) out_.fail(start, "GENERATE needs a first and a last id");
      const std::int64_t step = range.size() > 2 ? range[2] : 1;
      if (step < 1 || range[0] < 1 || range[0] > range[1]) out_.fail(start, "a range that cannot be generated");
      set.ranges.push_back({range[0], range[1], step});
    }
    scope_->sets.push_back(std::move(set));
  }

  void surface(Cursor& cursor, const Keyword& keyword) {
    refuse_file(keyword);
    const std::string* type = keyword.find("TYPE");
    const bool of_nodes = type && same_word(*type, "NODE");
    AbaqusSet set{.kind = of_nodes ? AbaqusSet::node_surface : AbaqusSet::surface,
                  .name = required(keyword, "NAME"),
                  .at = keyword.at};
    if (const std::string* instance = keyword.find("INSTANCE")) set.instance = *instance;
    if (const std::string* combine = keyword.find("COMBINE")) set.combine = upper_case(*combine);
    bool ignored = false;
    int n_areas = 0;
    while (data_line(cursor, ignored)) {
      if (!set.combine.empty()) {
        each_word(cursor, [&](std::string_view word, const char* at) {
          if (!word.empty()) set.members.push_back({unquoted(word), at});
        });
        continue;
      }
      AbaqusMember member;
      std::string face;
      int i = 0;
      each_word(cursor, [&](std::string_view word, const char* at) {
        if (i == 0) member = {unquoted(word), at};
        if (i == 1) face = upper_case(word);
        if (i == 1 && of_nodes && !word.empty() && word != "1" && word != "1." && word != "1.0" && n_areas++ == 0)
          out_.notices.push_back(out_.where(at) + ": areas of the nodes of surface " + shown(set.name) +
                                 " are left out: they are 1 in a file of ours");
        ++i;
      });
      if (!of_nodes)
        set.surface_members.emplace_back(member, face);
      else if (const auto id = number(member.text))
        set.ids.push_back(*id);
      else
        set.members.push_back(member);
    }
    scope_->sets.push_back(std::move(set));
  }

  void instance(Cursor& cursor, const Keyword& keyword) {
    const std::string name = upper_case(required(keyword, "PART"));
    const AbaqusScope* part = nullptr;
    for (const auto& scope : out_.scopes)
      if (scope->kind == AbaqusScope::part && upper_case(scope->name) == name) part = scope.get();
    if (!part) out_.fail(keyword.at, "there is no part " + shown(name));
    AbaqusInstance instance{part, &open_scope(AbaqusScope::instance, keyword, required(keyword, "NAME"))};
    // A translation, then two points of an axis and an angle in degrees.
    bool ignored = false;
    for (int line = 0; line < 2 && data_line(cursor, ignored); ++line) {
      std::array<double, 7> x{};
      const int n = line == 0 ? 3 : 7;
      for (int i = 0; i < n; ++i) {
        if (!line_ends(cursor)) x[i] = cursor.real("a number");
        comma(cursor);
      }
      cursor.line();
      if (line == 0) {
        instance.shift = Vec3(x[0], x[1], x[2]);
        continue;
      }
      const Vec3 a(x[0], x[1], x[2]), b(x[3], x[4], x[5]);
      if (!((b - a).norm() > 0)) out_.fail(keyword.at, "the axis of rotation has no direction");
      instance.turn = Eigen::AngleAxisd(x[6] * std::numbers::pi / 180, (b - a).normalized()).toRotationMatrix();
      instance.shift = instance.turn * (instance.shift - a) + a;
    }
    out_.instances.push_back(instance);
  }

  void include(const Keyword& keyword, const Cursor& cursor) {
    const std::filesystem::path file(required(keyword, "INPUT"));
    const auto folder = std::filesystem::path(std::string(cursor.name)).parent_path();
    const std::filesystem::path place = file.is_absolute() ? file : folder / file;
    if (!only_below_.empty() && !is_below(only_below_, place))
      out_.fail(keyword.at,
                place.string() + " is not below " + only_below_.string() + ", and others are not read here");
    read(std::make_unique<Bytes>(read_bytes(place)));
  }

  AbaqusContents& out_;
  const std::filesystem::path only_below_;
  AbaqusScope* scope_;
  std::set<std::string> known_;  // types that were told of
  bool begun_ = false, ended_ = false;
};

}  // namespace

MeshFile read_abaqus(const std::filesystem::path& file, const Fence& fence) {
  AbaqusContents contents;
  Parser parser(contents, fence.folder);
  const auto check = [&] {
    for (const auto& bytes : contents.sources) check_unchanged(*bytes);
  };
  try {
    parser.read(std::make_unique<Bytes>(read_bytes(file)));
    parser.finish();
    check();
  } catch (const Error&) {
    check();
    throw;
  }
  MeshFile out;
  out.notices = std::move(contents.notices);
  const AbaqusParts parts = place_abaqus(contents, out);
  add_abaqus_sets(contents, parts, out);
  if (parts.middles.any()) take_middles(out, parts.middles);
  return out;
}

}  // namespace hextwist::io
