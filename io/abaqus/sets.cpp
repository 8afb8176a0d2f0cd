// Sets and surfaces of an Abaqus file become blocks, side sets and node sets; element types and cards follow them.
//
// Element sets are blocks (of hexes and other elements), node sets and surfaces of nodes are node sets,
// surfaces of elements side sets; ids count them in the order of the file. Sets of a part or an instance are named
// instance.set, as Abaqus names them from outside.
#include <limits>
#include <map>
#include <set>

#include "hextwist/base/sorted.h"
#include "hextwist/io/abaqus/abaqus_internal.h"
#include "hextwist/io/others.h"

namespace hextwist::io {
namespace {

using Reference = AbaqusCard::Reference;

/// A set at its place.
using Placed = std::pair<const AbaqusPlaced*, const AbaqusSet*>;

/// Members of a set: indices of the mesh, others by their place among the other elements.
struct Members {
  std::vector<Index> nodes, hexes, others;
  std::vector<Side> sides;
  std::vector<std::pair<Index, std::string>> other_sides;
  std::set<Placed> from = {};  ///< sets that are in already: naming one again and again costs nothing
};

class Sets {
 public:
  Sets(const AbaqusContents& contents, const AbaqusParts& parts, MeshFile& out)
      : in_(contents), parts_(parts), out_(out) {}

  void run() {
    for (const AbaqusPlaced& placed : parts_.placed)
      each_scope(placed, [&](const AbaqusScope& scope) {
        for (const AbaqusSet& set : scope.sets) add_set(placed, set);
      });
    finish_sets();
    set_element_types(parts_, out_);
    cards();
    out_.extras.heading = in_.heading;
    say_missing();
  }

 private:
  template <class F>
  static void each_scope(const AbaqusPlaced& placed, const F& f) {
    for (const AbaqusScope* scope : placed.scopes)
      if (scope) f(*scope);
  }

  const AbaqusPlaced* find_instance(std::string_view name) const {
    for (const AbaqusPlaced& placed : parts_.placed)
      if (!placed.name.empty() && same_word(placed.name, name)) return &placed;
    return nullptr;
  }

  void missing(const char* kind, std::int64_t id, std::uint64_t n) {
    if (n == 0) return;
    if (n_missing_ == 0)
      first_missing_ = std::string(kind) + " " + std::to_string(id) + " in '" + (current_ ? current_->name : "") + "'";
    n_missing_ += std::min(n, std::numeric_limits<std::uint64_t>::max() - n_missing_);
  }
  bool add_node(const AbaqusPlaced& placed, std::int64_t id, Members& to) const {
    const Index node = parts_.nodes.find(placed.nodes(id));
    if (node >= 0) to.nodes.push_back(node);
    return node >= 0;
  }
  bool add_element(const AbaqusPlaced& placed, std::int64_t id, Members& to) const {
    const std::int64_t in_mesh = placed.elements(id);
    if (const Index hex = parts_.hexes.find(in_mesh); hex >= 0) {
      to.hexes.push_back(hex);
      return true;
    }
    const Index other = parts_.others.find(in_mesh);
    if (other >= 0) to.others.push_back(other);
    return other >= 0;
  }
  void add(const AbaqusPlaced& placed, bool nodes, std::int64_t id, Members& to) {
    if (!(nodes ? add_node(placed, id, to) : add_element(placed, id, to))) missing(nodes ? "node" : "element", id, 1);
  }

  /// GENERATE, in time and memory of what there is.
  void add_range(const AbaqusPlaced& placed, bool nodes, const std::array<std::int64_t, 3>& range, Members& to) {
    const auto [first, last, step] = range;
    const auto size =
        (static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first)) / static_cast<std::uint64_t>(step);
    std::uint64_t n = 0;
    std::int64_t lost = 0;
    const AbaqusPlaced::Numbers& own = nodes ? placed.nodes : placed.elements;
    if (own.low > own.high) return missing(nodes ? "node" : "element", first, size + 1);
    // The first of the range that the place may have, and from there on.
    const std::int64_t from = std::max(first, own.low), to_last = std::min(last, own.high);
    if (from <= to_last) {
      const auto skipped = (static_cast<std::uint64_t>(from) - static_cast<std::uint64_t>(first) +
                            static_cast<std::uint64_t>(step) - 1) /
                           static_cast<std::uint64_t>(step);
      const std::uint64_t end =
          (static_cast<std::uint64_t>(to_last) - static_cast<std::uint64_t>(first)) / static_cast<std::uint64_t>(step);
      const auto all = static_cast<std::uint64_t>(std::max(nodes ? parts_.nodes.size() : n_elements(), Index{1}));
      if (end >= skipped && end - skipped > 8 * all) return add_sparse_range(placed, nodes, range, to);
      for (std::uint64_t k = skipped; k <= end; ++k) {
        const auto id =
            static_cast<std::int64_t>(static_cast<std::uint64_t>(first) + k * static_cast<std::uint64_t>(step));
        if (nodes ? add_node(placed, id, to) : add_element(placed, id, to))
          ++n;
        else if (lost == 0)
          lost = id;
      }
    }
    missing(nodes ? "node" : "element", lost ? lost : first < own.low ? first : last, size + 1 - n);
  }
  Index n_elements() const { return parts_.hexes.size() + parts_.others.size(); }
  /// The same over the ids that there are.
  void add_sparse_range(const AbaqusPlaced& placed, bool nodes, const std::array<std::int64_t, 3>& range, Members& to) {
    const auto [first, last, step] = range;
    std::uint64_t n = 0;
    const auto take = [&](const std::vector<std::int64_t>& ids) {
      for (const std::int64_t id : ids)
        if (id >= first && id <= last && (id - first) % step == 0)
          n += nodes ? add_node(placed, id, to) : add_element(placed, id, to);
    };
    each_scope(placed, [&](const AbaqusScope& scope) {
      if (nodes) return take(scope.node_ids);
      for (const auto* ids : {&scope.hex_ids, &scope.other_ids}) take(*ids);
    });
    missing(nodes ? "node" : "element", first,
            (static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first)) / static_cast<std::uint64_t>(step) +
                1 - n);
  }

  static bool of_nodes(AbaqusSet::Kind kind) { return kind == AbaqusSet::nodes || kind == AbaqusSet::node_surface; }

  bool is_open(const Placed& set) const { return std::ranges::find(open_, set) != open_.end(); }
  /// A set whose members are looked for, as long as this lives.
  struct Open {
    std::vector<Placed>& all;
    Open(Sets& sets, const Placed& set) : all(sets.open_) {
      constexpr std::size_t most = 50;
      if (sets.is_open(set)) sets.in_.fail(set.second->at, "set " + shown(set.second->name) + " contains itself");
      if (all.size() == most)
        sets.in_.fail(set.second->at,
                      "set " + shown(set.second->name) + " is in sets in sets, " + std::to_string(most) + " of them");
      all.push_back(set);
    }
    ~Open() { all.pop_back(); }
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;
  };

  /// Members of a set with the sets that it names.
  void resolve(const AbaqusPlaced& placed, const AbaqusSet& set, Members& to) {
    const Open here(*this, {&placed, &set});
    const AbaqusPlaced* home = &placed;
    if (!set.instance.empty()) {
      home = find_instance(set.instance);
      if (!home) in_.fail(set.at, "there is no instance " + shown(set.instance));
    }
    for (const std::int64_t id : set.ids) add(*home, of_nodes(set.kind), id, to);
    for (const auto& range : set.ranges) add_range(*home, of_nodes(set.kind), range, to);
    for (const AbaqusMember& member : set.members) resolve_member(*home, of_nodes(set.kind), member, to);
    if (!set.elset.empty()) {
      Members elements;
      resolve_member(*home, false, {set.elset, set.at}, elements);
      for (const Index h : elements.hexes)
        to.nodes.insert(to.nodes.end(), out_.mesh.hexes[h].begin(), out_.mesh.hexes[h].end());
      for (const Index e : elements.others) {
        const auto nodes = out_.mesh.others->nodes_of(e);
        to.nodes.insert(to.nodes.end(), nodes.begin(), nodes.end());
      }
    }
  }
  /// The place and the rest of "Instance.rest"; the place itself where no instance is named.
  std::pair<const AbaqusPlaced*, std::string> split(const AbaqusPlaced& placed, const std::string& name) const {
    for (auto dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1))
      if (const AbaqusPlaced* instance = find_instance(std::string_view(name).substr(0, dot)))
        return {instance, name.substr(dot + 1)};
    return {&placed, name};
  }
  static std::optional<std::int64_t> number(const std::string& text) {
    std::int64_t id = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc{} || stop != text.data() + text.size()) return {};
    return id;
  }
  void resolve_member(const AbaqusPlaced& placed, bool nodes, const AbaqusMember& member, Members& to) {
    const auto place = split(placed, member.text);
    const AbaqusPlaced& home = *place.first;
    const std::string& name = place.second;
    if (const auto id = number(name)) return add(home, nodes, *id, to);
    bool found = false;
    each_scope(home, [&](const AbaqusScope& scope) {
      for (const AbaqusSet& other : scope.sets)
        if (other.kind == (nodes ? AbaqusSet::nodes : AbaqusSet::elements) && same_word(other.name, name)) {
          found = true;
          if (is_open({&home, &other}) || to.from.insert({&home, &other}).second) resolve(home, other, to);
        }
    });
    if (!found) in_.fail(member.at, "there is no set " + shown(member.text));
  }

  static std::string full_name(const AbaqusPlaced& placed, const std::string& name) {
    return placed.name.empty() ? name : placed.name + "." + name;
  }

  void add_set(const AbaqusPlaced& placed, const AbaqusSet& set) {
    current_ = &set;
    Members members;
    resolve_any(placed, set, members);
    current_ = nullptr;
    const std::string name = full_name(placed, set.name), key = upper_case(name);
    // The sets of everything that we write ourselves.
    if (set.kind == AbaqusSet::elements && in_.real_names.contains({"faces", key})) return;  // of a load
    if (in_.ours && (key == "NALL" || key == "EALL") && !in_.real_names.contains({kind_words[set.kind], key})) return;
    auto& to = sets_[{set.kind, key}];
    if (to.order == 0) to = {sets_.size(), name, {}};
    for (auto [from, into] : {std::pair(&members.nodes, &to.members.nodes),
                              {&members.hexes, &to.members.hexes},
                              {&members.others, &to.members.others}})
      into->insert(into->end(), from->begin(), from->end());
    to.members.sides.insert(to.members.sides.end(), members.sides.begin(), members.sides.end());
    to.members.other_sides.insert(to.members.other_sides.end(), members.other_sides.begin(), members.other_sides.end());
  }

  /// Of any kind, surfaces made of others as well.
  void resolve_any(const AbaqusPlaced& placed, const AbaqusSet& set, Members& to) {
    if (!set.combine.empty()) return combine(placed, set, to);
    if (set.kind != AbaqusSet::surface) return resolve(placed, set, to);
    std::set<std::pair<std::string, std::string>> done;  // a set with a face that is named again adds nothing
    for (const auto& [member, face] : set.surface_members)
      if (number(member.text) || done.emplace(upper_case(member.text), face).second)
        add_surface(placed, set, member, face, to);
  }

  /// A surface made of others (Abaqus Keywords Reference, *SURFACE, COMBINE).
  void combine(const AbaqusPlaced& placed, const AbaqusSet& set, Members& to) {
    const Open here(*this, {&placed, &set});
    const bool is_union = set.combine == "UNION", is_difference = set.combine == "DIFFERENCE";
    if (!is_union && !is_difference && set.combine != "INTERSECTION")
      in_.fail(set.at, "COMBINE=" + set.combine + "; known are UNION, INTERSECTION and DIFFERENCE");
    if (set.members.empty() || (!is_union && set.members.size() != 2))
      in_.fail(set.at, "COMBINE=" + set.combine + " of " + counted(set.members.size(), "surface"));
    for (const AbaqusMember& member : set.members) {
      const Members& next = surface_of(placed, set, member);
      const auto put = [&](auto list) {
        auto& own = to.*list;
        const auto& other = next.*list;
        std::remove_reference_t<decltype(own)> both;
        if (&member == &set.members.front())
          both = other;
        else if (is_union)
          std::ranges::set_union(own, other, std::back_inserter(both));
        else if (is_difference)
          std::ranges::set_difference(own, other, std::back_inserter(both));
        else
          std::ranges::set_intersection(own, other, std::back_inserter(both));
        own = std::move(both);
      };
      put(&Members::nodes);
      put(&Members::sides);
      put(&Members::other_sides);
    }
  }
  /// What a surface of that name and of the set's kind has, sorted.
  const Members& surface_of(const AbaqusPlaced& placed, const AbaqusSet& set, const AbaqusMember& member) {
    const auto place = split(placed, member.text);
    const AbaqusPlaced& home = *place.first;
    const AbaqusSet* found = nullptr;
    each_scope(home, [&](const AbaqusScope& scope) {
      for (const AbaqusSet& other : scope.sets)
        if (!found && other.kind == set.kind && same_word(other.name, place.second)) found = &other;
    });
    if (!found)
      in_.fail(member.at, "there is no surface " + shown(member.text) +
                              (set.kind == AbaqusSet::surface ? " of elements" : " of nodes"));
    if (const auto known = surfaces_.find({&home, found}); known != surfaces_.end()) return known->second;
    Members result;
    resolve_any(home, *found, result);
    sort_unique(result.nodes);
    sort_unique(result.sides);
    sort_unique(result.other_sides);
    return surfaces_.emplace(Placed(&home, found), std::move(result)).first->second;
  }

  void add_surface(const AbaqusPlaced& placed, const AbaqusSet& set, const AbaqusMember& member,
                   const std::string& face, Members& to) {
    const AbaqusPlaced* home = set.instance.empty() ? &placed : find_instance(set.instance);
    if (!home) in_.fail(set.at, "there is no instance " + shown(set.instance));
    Members elements;
    resolve_member(*home, false, member, elements);
    for (const Index e : elements.others) to.other_sides.emplace_back(e, face);
    if (elements.hexes.empty()) return;
    if (face.empty()) {
      // Without a face: those that are on the skin.
      if (!skin_) skin_ = boundary_sides(faces(out_.mesh));
      sort_unique(elements.hexes);
      for (const Side& side : *skin_)
        if (std::ranges::binary_search(elements.hexes, side.hex)) to.sides.push_back(side);
      return;
    }
    const int number = face.size() == 2 && face[0] == 'S' ? face[1] - '0' : 0;
    if (number < 1 || number > 6) in_.fail(member.at, "face " + shown(face) + " of a hex; known are S1 to S6");
    for (const Index h : elements.hexes) to.sides.push_back({h, abaqus_face[number - 1]});
  }

  void finish_sets() {
    std::vector<std::pair<std::size_t, std::pair<AbaqusSet::Kind, std::string>>> order;
    for (const auto& [key, set] : sets_) order.emplace_back(set.order, key);
    std::ranges::sort(order);
    Mesh& mesh = out_.mesh;
    std::string empty;
    std::vector<OtherSet> sets_of_others;
    std::vector<OtherSides> sides_of_others;
    std::vector<std::uint8_t> is_rigid(static_cast<std::size_t>(n_others(mesh)), 0);
    bool any_rigid = false;
    for (const auto& [position, key] : order) {
      auto& [unused, name, members, block, other] = sets_[key];
      sort_unique(members.nodes);
      sort_unique(members.hexes);
      sort_unique(members.sides);
      sort_unique(members.others);
      sort_unique(members.other_sides);
      const auto real = [&](const char* kind, auto& groups) -> auto& {
        const auto known = in_.real_names.find({kind, key.second});
        auto& group = group_of_id(groups, known == in_.real_names.end() ? free_id(groups) : known->second.first);
        group.name = known == in_.real_names.end() ? name : known->second.second;
        return group;
      };
      if (of_nodes(key.first)) {
        NodeSet& set = real("nodeset", mesh.node_sets);
        set.nodes = std::move(members.nodes);
        other = {Reference::node_set, set.id};
        if (key.first == AbaqusSet::node_surface) out_.extras.node_surfaces.push_back(set.id);
      }
      if (key.first == AbaqusSet::surface) {
        SideSet& set = real("sideset", mesh.side_sets);
        set.sides = std::move(members.sides);
        other = {Reference::side_set, set.id};
        if (!members.other_sides.empty()) {
          OtherSides& to = sides_of_others.emplace_back();
          to.id = set.id;
          for (auto& [element, side] : members.other_sides) {
            // Edges of shells and ends of beams: pieces have them in part.
            if (side.starts_with("E") || (is_shell(element) && side.size() == 2 && side >= "S3" && side <= "S6"))
              is_rigid[element] = 1, any_rigid = true;
            to.elements.push_back(element);
            to.sides.push_back(std::move(side));
          }
        }
      }
      if (key.first != AbaqusSet::elements) continue;
      if (!members.hexes.empty() || !members.others.empty() || in_.real_names.contains({"block", key.second})) {
        Block& set = real("block", mesh.blocks);
        set.hexes = std::move(members.hexes);
        if (!members.others.empty()) sets_of_others.push_back({set.id, std::move(members.others)});
        block = set.id;
      } else {
        empty += (empty.empty() ? "'" : ", '") + name + "'";
      }
    }
    std::ranges::sort(out_.extras.node_surfaces);
    if (!empty.empty()) out_.notices.push_back("element sets without an element are left out: " + empty);
    if (!mesh.others) return;
    OtherHeads heads = *mesh.others->heads;
    heads.sets = std::move(sets_of_others);
    heads.sides = std::move(sides_of_others);
    if (any_rigid) heads.is_rigid = std::move(is_rigid);
    mesh.others = other_elements(std::move(heads), mesh.others->first, mesh.others->nodes);
  }

  /// What a word of a card stands for. Nothing where it is none of the mesh's sets: it stays as it is.
  struct Meaning {
    std::optional<std::pair<Reference::Kind, std::int64_t>> reference;
    bool lost = false;  ///< part of the file's mesh, but not of ours
  };
  Meaning meaning(const AbaqusPlaced& placed, AbaqusNamed::Kind kind, const std::string& word) const {
    const auto [home, name] = split(placed, word);
    if (const auto id = number(name)) {
      if (kind == AbaqusNamed::node_set || kind == AbaqusNamed::surface) return {};
      const bool nodes = kind == AbaqusNamed::nodes;
      Index at = nodes ? parts_.nodes.find(home->nodes(*id)) : parts_.hexes.find(home->elements(*id));
      if (!nodes && at < 0) at = parts_.others.find(home->elements(*id));
      if (at < 0 || (nodes && !parts_.is_middle.empty() && parts_.is_middle[at])) return {{}, true};
      return {std::pair(nodes ? Reference::node : Reference::hex, nodes ? home->nodes(*id) : home->elements(*id)),
              false};
    }
    const std::string key = upper_case(full_name(*home, name));
    std::vector<AbaqusSet::Kind> kinds = {AbaqusSet::nodes};
    if (kind == AbaqusNamed::elements) kinds = {AbaqusSet::elements};
    if (kind == AbaqusNamed::surface) kinds = {AbaqusSet::surface, AbaqusSet::node_surface};
    for (const auto one : kinds) {
      const auto found = sets_.find({one, key});
      if (found == sets_.end()) continue;
      if (one == AbaqusSet::elements)
        return found->second.block > 0 ? Meaning{std::pair(Reference::block, std::int64_t{found->second.block}), false}
                                       : Meaning{{}, true};
      return {found->second.other, false};
    }
    return {};
  }

  /// In the order of the file, but those of parts and the assembly before the first step: CalculiX wants materials
  /// before sections.
  void cards() {
    auto& cards = out_.extras.cards;
    std::size_t n_model = 0;
    AbaqusCardsOfPlaces places;
    for (const AbaqusPlaced& placed : parts_.placed) {
      bool is_last_there = false;  // already
      for (const AbaqusRawCard& card : places.of(in_, placed, out_.notices))
        is_last_there = !add_card(placed, card, is_last_there || !belongs_to_last(card));
      if (placed.scopes[0]->kind == AbaqusScope::model) n_model = cards.size();
    }
    const auto model_end = cards.begin() + static_cast<std::ptrdiff_t>(n_model);
    const auto step = std::find_if(
        cards.begin(), model_end, [](const AbaqusCard& card) { return upper_case(card.text.substr(0, 5)) == "*STEP"; });
    std::rotate(step, model_end, cards.end());
    if (n_numbers_ > 0)
      out_.notices.push_back("cards name nodes or elements by number, " + std::to_string(n_numbers_) +
                             " times, first at " + first_number_ + ": what a refinement adds is not among them");
    if (!first_node_load_.empty())
      out_.notices.push_back(first_node_load_ +
                             ": a load on a node set is the same at each node: nodes that a refinement adds to the set "
                             "have it too, so that the sum grows");
    if (!load_sets_.empty()) {
      std::vector<std::string> names;
      for (const auto& [of, id] : load_sets_) names.push_back(group_of_id(out_.mesh.side_sets, id).name);
      out_.notices.push_back("loads on faces of elements are on side sets here: " + joined(names, ", "));
    }
    if (!rigid_.empty()) {
      OtherHeads heads = *out_.mesh.others->heads;
      heads.is_rigid.resize(static_cast<std::size_t>(n_others(out_.mesh)), 0);
      for (const Index e : rigid_) heads.is_rigid[e] = 1;
      out_.mesh.others = other_elements(std::move(heads), out_.mesh.others->first, out_.mesh.others->nodes);
    }
    if (in_.n_normals > 0)
      out_.notices.push_back("more than coordinates of " + counted(in_.n_normals, "node") +
                             " is left out (normals), first of node " + std::to_string(in_.first_normal));
  }

  /// The side set that a load on a face of elements is on; nothing where it stays with the elements.
  std::optional<std::int64_t> loaded_faces(const AbaqusPlaced& placed, const AbaqusFaceLoad& load) {
    Mesh& mesh = out_.mesh;
    if (const auto own = in_.real_names.find({"faces", upper_case(load.elements)}); own != in_.real_names.end()) {
      const bool is_there = std::ranges::find(mesh.side_sets, own->second.first, &SideSet::id) != mesh.side_sets.end();
      return is_there ? std::optional<std::int64_t>(own->second.first) : std::nullopt;
    }
    const auto set = meaning(placed, AbaqusNamed::elements, load.elements).reference;
    if (!set || set->first != Reference::block) return {};
    const Block& block = *std::ranges::find(mesh.blocks, static_cast<int>(set->second), &Block::id);
    if (block.hexes.empty() || !others_of_block(mesh, block.id).empty()) return {};
    const auto [known, is_new] = load_sets_.try_emplace({block.id, load.face}, free_id(mesh.side_sets));
    if (is_new) {
      SideSet& to = group_of_id(mesh.side_sets, known->second);
      to.name = load.elements + "_S" + std::to_string(load.face);
      for (const Index h : block.hexes) to.sides.push_back({h, abaqus_face[load.face - 1]});
      sort_unique(to.sides);
    }
    return known->second;
  }

  /// What is said of an edge or an end of elements, which their pieces have in part: ends of beams, edges of shells
  /// (with CalculiX their faces from the third on).
  void keep_whole(const AbaqusRawCard& raw, const Reference& of) {
    const std::string rest = upper_case(raw.text.substr(of.end, line_around(raw.text, of.end).second - of.end));
    const std::string_view label = trimmed(std::string_view(rest).substr(rest.find(',') + 1));
    const bool is_of_end = raw.keyword == "RELEASE" || (raw.keyword == "DLOAD" && label.starts_with("ED"));
    const std::size_t digit = label.find_first_of("0123456789"), word_end = label.find(',');
    const bool is_of_edge = has_faces(raw.keyword) && digit < word_end && label[digit] >= '3' && label[digit] <= '6';
    if (!is_of_end && !is_of_edge) return;
    const auto add = [&](Index e) {
      if (is_of_end || is_shell(e)) rigid_.push_back(e);
    };
    if (of.kind == Reference::block)
      std::ranges::for_each(others_of_block(out_.mesh, static_cast<int>(of.id)), add);
    else if (const Index e = parts_.others.find(of.id); e >= 0)
      add(e);
  }
  bool is_shell(Index other) const {
    const OtherShape shape = out_.mesh.others->type_of(other).shape;
    return shape == OtherShape::quad || shape == OtherShape::triangle;
  }

  /// can_be_there: for another place; false: it belongs to what was added last. Returns whether it was added.
  bool add_card(const AbaqusPlaced& placed, const AbaqusRawCard& raw, bool can_be_there) {
    AbaqusCard card{raw.text, {}, in_.where(raw.at)};
    std::vector<std::pair<std::size_t, std::size_t>> lost_lines, same_lines;
    std::string lost;
    for (const AbaqusNamed& named : raw.named) {
      std::string word = raw.text.substr(named.begin, named.end - named.begin);
      std::size_t end = named.end;
      auto kind = named.kind;
      if (kind == AbaqusNamed::faces) {
        const AbaqusFaceLoad load = abaqus_face_load(word);
        if (const auto faces = loaded_faces(placed, load)) {
          const AbaqusCard::Reference here{Reference::faces, *faces, named.begin, named.end, false};
          const auto rest = [&](const AbaqusCard::Reference& of) {
            return abaqus_face_load(raw.text.substr(of.begin, of.end - of.begin)).label(0) +
                   raw.text.substr(of.end, line_around(raw.text, of.end).second - of.end);
          };
          // One load is a line for each face of elements in a file of ours.
          if (std::ranges::any_of(card.references, [&](const auto& of) {
                return of.kind == Reference::faces && of.id == *faces && rest(of) == rest(here);
              }))
            same_lines.push_back(line_around(raw.text, named.begin));
          else
            card.references.push_back(here);
          continue;
        }
        kind = AbaqusNamed::elements;
        word = load.elements;
        end = named.begin + load.end;
      }
      std::erase(word, '"');
      const auto [reference, gone] = meaning(placed, kind, word);
      if (reference) {
        card.references.push_back({reference->first, reference->second, named.begin, end, named.by_keyword});
        if (!named.by_keyword) keep_whole(raw, card.references.back());
      }
      if (reference && reference->first == Reference::node_set && first_node_load_.empty() &&
          (raw.keyword == "CLOAD" || raw.keyword == "CFLUX"))
        first_node_load_ = card.where + ": *" + raw.keyword;
      if (!gone) continue;
      lost += (lost.empty() ? "'" : ", '") + word + "'";
      if (named.by_keyword) {
        out_.notices.push_back(card.where + ": *" + raw.keyword + " is left out: it is about " + lost +
                               ", of which nothing is kept");
        return false;
      }
      lost_lines.push_back(line_around(raw.text, named.begin));
    }
    sort_unique(lost_lines);
    const auto cut = union_of(lost_lines, same_lines);
    for (auto line = cut.rbegin(); line != cut.rend(); ++line) cut_out(card, line->first, line->second);
    if (!lost_lines.empty())
      out_.notices.push_back(card.where + ": lines of *" + raw.keyword + " about " + lost +
                             " are left out: nothing of that is kept");
    // The same for each instance of a part: an orientation, ...
    const bool there = can_be_there && card.references.empty() && placed.scopes[0]->kind == AbaqusScope::part &&
                       std::ranges::find(out_.extras.cards, card.text, &AbaqusCard::text) != out_.extras.cards.end();
    if (there) return false;
    for (const Reference& reference : card.references)
      if (reference.kind == Reference::node || reference.kind == Reference::hex)
        if (n_numbers_++ == 0) first_number_ = card.where;
    out_.extras.cards.push_back(std::move(card));
    return true;
  }

  void say_missing() {
    if (n_missing_ == 0) return;
    out_.notices.push_back("sets name " + std::to_string(n_missing_) +
                           " nodes or elements that are not there; the first is " + first_missing_);
  }

  struct Collected {
    std::size_t order = 0;
    std::string name;
    Members members;
    int block = 0;  ///< what it became
    std::pair<Reference::Kind, std::int64_t> other = {Reference::node_set, 0};
  };
  static constexpr std::array<const char*, 4> kind_words = {"nodeset", "block", "sideset", "nodeset"};

  const AbaqusContents& in_;
  const AbaqusParts& parts_;
  MeshFile& out_;
  std::map<std::pair<AbaqusSet::Kind, std::string>, Collected> sets_;
  std::optional<std::vector<Side>> skin_;
  const AbaqusSet* current_ = nullptr;
  std::vector<Placed> open_;                      // sets in which the one at hand is
  std::map<Placed, Members> surfaces_;            // that others are made of
  std::map<std::pair<int, int>, int> load_sets_;  // block and number of a face: side set
  std::string first_node_load_;
  std::vector<Index> rigid_;  // other elements
  std::uint64_t n_missing_ = 0;
  std::string first_missing_;
  std::int64_t n_numbers_ = 0;
  std::string first_number_;
};

}  // namespace

void add_abaqus_sets(const AbaqusContents& contents, const AbaqusParts& parts, MeshFile& out) {
  Sets(contents, parts, out).run();
}

}  // namespace hextwist::io
