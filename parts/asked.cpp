#include "hextwist/parts/asked.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "hextwist/base/text.h"
#include "hextwist/command/braces.h"
#include "hextwist/command/error_at.h"
#include "hextwist/command/flow.h"
#include "hextwist/command/foreign.h"
#include "hextwist/session/commands/request.h"
#include "hextwist/session/session.h"
#include "hextwist/sizing/targets.h"

namespace hextwist {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& why) {
  throw NeedsWhole(what + ": " + why);
}

bool is_set(EntityKind kind) {
  return !is_mesh(kind) && !is_cad(kind);
}

[[noreturn]] void refuse_sets() {
  refuse("a choice of blocks or sets by what is in them", "a part does not see all of that");
}
[[noreturn]] void refuse_cad() {
  refuse("a choice of CAD entities by what the mesh has at them", "a part does not see all of that");
}
[[noreturn]] void refuse_numbers() {
  refuse("an edge or a face by its number", "numbers are those of the whole mesh");
}

void check_attribute(Attribute attribute, EntityKind kind) {
  const bool is_id = attribute == Attribute::id;
  if (is_id && (kind == EntityKind::edge || kind == EntityKind::face)) refuse_numbers();
  if (!is_id && attribute != Attribute::name && is_set(kind)) refuse_sets();
  if (!is_cad(kind)) return;
  for (const Attribute of_mesh :
       {Attribute::quality, Attribute::is_meshed, Attribute::element_count, Attribute::block_assigned})
    if (attribute == of_mesh) refuse_cad();
}

/// RangeItem::step of ids that were a span.
constexpr std::int64_t within_span = 0, end_of_span = 2;

void check_range(EntityKind kind, const Range& range, bool of_cad, std::vector<NamedId>* ids);

/// Whether a condition asks for more than a part knows.
void check_criterion(const Criterion& criterion, EntityKind kind, bool of_cad) {
  if (criterion.op == Criterion::Op::attribute) {
    for (const RangeTerm& term : criterion.of) check_range(term.kind, term.range, of_cad, nullptr);
    check_attribute(criterion.attribute, criterion.of.empty() ? kind : criterion.of[0].kind);
  }
  for (const Criterion& operand : criterion.operands) check_criterion(operand, kind, of_cad);
}

/// Refuses what a part can't find out by itself, and collects ids.
void check_range(EntityKind kind, const Range& range, bool of_cad, std::vector<NamedId>* ids) {
  const auto names_mesh = is_mesh(kind);
  if (kind == EntityKind::sheet) refuse("a sheet", "sheets run through the whole mesh");
  for (const RangeItem& item : range.items) {
    if (is_set(kind) && (item.kind == RangeItem::Kind::within || item.kind == RangeItem::Kind::at)) refuse_sets();
    if (item.kind == RangeItem::Kind::all || item.kind == RangeItem::Kind::within || !names_mesh) continue;
    if (item.kind == RangeItem::Kind::at) refuse("what is nearest to a point", "it may lie in any part");
    if (kind == EntityKind::edge || kind == EntityKind::face) refuse_numbers();
    if (item.kind != RangeItem::Kind::id && item.kind != RangeItem::Kind::span) continue;
    if (!ids) refuse("an id of a node or hex inside a range", "it may lie in any part");
    // Of a span some may be missing, as to a single process; its ends show that it does not go beyond what there is.
    ids->push_back({item.first, item.step == within_span, item.step == end_of_span});
  }
  if (of_cad && !is_cad(kind)) refuse_cad();
  for (const RangeFilter& filter : range.filters) {
    using Test = RangeFilter::Test;
    if (filter.kind == RangeFilter::Kind::most ||
        (filter.kind == RangeFilter::Kind::field && (filter.test == Test::top || filter.test == Test::bottom)))
      refuse("a choice of the largest or smallest", "values are compared over the whole mesh");
    if (filter.kind == RangeFilter::Kind::with)
      check_criterion(filter.criterion, kind, is_cad(kind));
    else if (filter.kind != RangeFilter::Kind::except && is_set(kind))
      refuse_sets();
    if (filter.kind == RangeFilter::Kind::field && is_cad(kind)) refuse_cad();
    for (const RangeTerm& term : filter.terms)
      check_range(term.any_kind ? kind : term.kind, term.range, is_cad(kind), nullptr);
  }
}

/// Commands that begin with another mesh, or end.
constexpr std::array<std::string_view, 8> of_sessions = {"brick",  "create", "cylinder", "exit",
                                                         "import", "quit",   "reset",    "sphere"};

/// Also said of a volume.
constexpr std::array<std::string_view, 4> of_places = {"move", "reflect", "rotate", "scale"};

/// Commands that put the mesh on another model; empty: it is none.
std::string of_models(const Command& command) {
  const std::string_view name = command.spec->name;
  for (const std::string_view word : of_places)
    if (name == word || (name == "volume" && command.has(word))) return std::string(word);
  return name == "project" && command.find("file") ? "project to geometry" : "";
}

constexpr std::int64_t most_ids = 1000000;  // of a span

/// Spans of ids of nodes and hexes, id by id: a part has some of them only. Steps say which is which.
void spell_out(EntityKind kind, Range& range) {
  if (kind != EntityKind::node && kind != EntityKind::hex) return;
  std::vector<RangeItem> items;
  for (RangeItem& item : range.items) {
    if (item.kind != RangeItem::Kind::span) {
      items.push_back(std::move(item));
      continue;
    }
    const std::int64_t last = (item.last - item.first) / item.step;
    if (last >= most_ids) refuse("a span of more than a million ids", "each is looked for");
    for (std::int64_t k = 0; k <= last; ++k) {
      RangeItem one = item;
      one.kind = RangeItem::Kind::id;
      one.first = one.last = item.first + k * item.step;
      one.step = k == 0 || k == last ? end_of_span : within_span;
      items.push_back(std::move(one));
    }
  }
  range.items = std::move(items);
}

/// Takes out the ids that are not here. False: none was left.
bool keep_ids_here(const Mesh& mesh, EntityKind kind, Range& range) {
  if (range.items.empty() || (kind != EntityKind::node && kind != EntityKind::hex)) return true;
  std::erase_if(range.items, [&](const RangeItem& item) {
    return item.kind == RangeItem::Kind::id &&
           (kind == EntityKind::node ? find_node(mesh, item.first) : find_hex(mesh, item.first)) < 0;
  });
  return !range.items.empty();
}

void check_sizes(const Request& request, Approach approach) {
  const Sizes& sizes = std::get<Sizes>(request.how);
  const EntityKind kind = request.target.kind;
  if (sizes.size && !is_cad(kind) && (kind != EntityKind::hex || sizes.bias > 1))
    refuse("a size at nodes, edges, faces or hexes", "others may be nearer");
  if (sizes.field && sizes.bias > 1)
    refuse("a sizing function with a bias", "its growth is limited over the whole mesh");
  if (approach == Approach::nearest_size && may_halve(request))
    refuse("a size that is the same everywhere",
           "it may be met by one into eight, whose sheets run through the whole mesh");
  if (request.concave == Concave::fill) refuse("sizes with 'concave fill'", "regions are filled pass by pass");
}

void check_request(const Request& request, Approach approach) {
  switch (approach) {
    case Approach::uniform:
    case Approach::trisect:
    case Approach::levels:
    case Approach::parallel:
      break;
    case Approach::size_by_levels:
    case Approach::size_by_threes:
    case Approach::nearest_size:
      check_sizes(request, approach);
      break;
    case Approach::combination:
      if (std::get<Cuts>(request.how).numsplit > 1 && is_regular(request))
        refuse("numsplit above 1 along nodes, curves and surfaces (depth 0)",
               "it goes by levels first; 'depth 1' can be");
      break;
    case Approach::eight:
      refuse("one into eight", "its sheets are planned through the whole mesh");
    case Approach::thickness:
    case Approach::layers:
    case Approach::sheets:
      refuse("a direction or a sheet", "sheets run through the whole mesh");
    case Approach::size_by_halves:
    case Approach::size_by_directions:
    case Approach::size_by_combination:
      refuse("a size by 'method parallel' or 'method combination'", "what is too large is looked at as a whole");
  }
  if (request.finish.smooth) refuse("smooth", "smoothing goes across parts");
  if (request.finish.dry_run) refuse("dry_run", "it counts without making anything");
}

std::string in_one_line(const std::exception& error) {
  if (const auto* at = dynamic_cast<const CommandError*>(&error)) return at->message();
  return error.what();
}

/// What the target is where it is here; else the reason in `nothing`.
void find_target(Execution& run, PartAsked& result) {
  try {
    target_of(run);
  } catch (const std::exception& error) {
    result.nothing = in_one_line(error);
    return;
  }
  Request request = request_of(run);
  const Approach approach = plan(*run.meshed, request).approach;
  check_request(request, approach);
  std::vector<std::string> told;
  try {
    if (const Sizes* sizes = std::get_if<Sizes>(&request.how)) {
      // Where nothing of the target is here, sizes may be wished for all the same, and others have to be told.
      result.asked = {request, approach, sizes->bias > 1 || approach == Approach::nearest_size, {}};
      result.asked.region = region_target(*run.meshed, request.target, told);
      if (result.asked.region.empty()) throw Error("there are no hexes at the target");
    } else if (request.target.radius) {
      request.target = {EntityKind::hex, region_target(*run.meshed, request.target, told)};
      request.method = Method::single;
    } else if (approach != Approach::uniform) {
      if (is_solid(request.target.kind))
        solid_target(*run.meshed, request.target);
      else
        sub_element_target(*run.meshed, request.target, told);
    }
  } catch (const Error& error) {
    result.nothing = error.what();
    return;
  }
  result.has_target = true;
  if (!std::holds_alternative<Sizes>(request.how)) result.asked = {std::move(request), approach, true, {}};
  result.asked.is_here = true;
}

/// The same request without a target: what others find together with this part.
void ask_without_target(Session::Core& core, Command command, PartAsked& result) {
  for (Item& item : command.items)
    if (!item.is_word && item.name == "range") item.range = {{RangeItem{}}, {}, {}};
  Execution run(core, command);
  result.asked = {request_of(run), {}, false, {}};
  result.asked.approach = plan(*run.meshed, result.asked.request).approach;
  result.asked.is_here = result.asked.approach == Approach::nearest_size;
}

/// Of the CAD alone.
void check_function(const Command& command) {
  if (command.has("list") || command.find("field"))
    refuse("a sizing function of a field, or a list of functions", "a part has its own hexes only");
  for (const Item* range : command.find_all("range")) {
    if (!is_cad(range->kind)) refuse("a sizing function at nodes, edges, faces or hexes", "others may be nearer");
    check_range(range->kind, range->range, true, nullptr);
  }
}

}  // namespace

PartCommands::PartCommands(std::span<const std::string> texts) : texts_(texts.begin(), texts.end()) {
  bool is_any = false;
  for (const std::string& text : texts)
    for (const Statement& statement : split_statements(text, "", 1)) {
      try {
        is_any = add(statement) || is_any;
      } catch (const NeedsWhole& needs) {
        is_any = true;
        if (by_whole_.empty()) by_whole_ = needs.why;
      }
    }
  if (!is_any) throw Error("no refinement was asked for");
}

bool PartCommands::add(const Statement& statement) {
  if (has_braces(statement) || flow_of(statement).kind != Flow::none) {
    names_.emplace_back();
    refuse("braces", "values may be those of the whole mesh");
  }
  Command command;
  if (const std::optional<Foreign> foreign = parse_or_skip(statement, command)) {
    notices_.push_back(skipped_text(*foreign));
    return false;
  }
  const std::string& name = names_.emplace_back(command.spec->name);
  const bool is_of_groups = (name == "create" && (command.has("group") || command.has("block"))) ||
                            (name == "reset" && (command.has("block") || command.has("nodeset") ||
                                                 command.has("sideset") || command.has("genesis")));
  if (!is_of_groups && std::ranges::find(of_sessions, name) != std::end(of_sessions))
    throw error_at(statement, statement.tokens.front(),
                   "'" + name + "' is for sessions of hextwist: here the mesh is read first and written in the end");
  if (const std::string moving = of_models(command); !moving.empty())
    throw error_at(statement, statement.tokens.front(),
                   "'" + moving + "' puts the mesh on another model: parts stay on theirs; run it with hextwist");
  if (name == "sizing") {
    check_function(command);
    functions_.push_back({commands_.size(), std::move(command)});
    return true;
  }
  if (name != "refine") refuse("'" + name + "'", "only refinements are done in parts");
  if (command.has("sheet")) refuse("a direction or a sheet", "sheets run through the whole mesh");
  if (command.find("x")) refuse("a place to refine at", "the nearest hex may lie in any part");
  std::vector<NamedId> ids;
  for (Item& item : command.items) {
    if (item.is_word || (item.name != "range" && item.name != "which")) continue;
    const bool is_target = item.name == "range";
    if (is_target) spell_out(item.kind, item.range);
    check_range(item.kind, item.range, is_target && is_cad(item.kind), is_target ? &ids : nullptr);
    if (is_mesh(item.kind) && command.find("radius"))
      refuse("a radius around nodes or hexes", "they may lie in any part");
  }
  ids_.push_back(std::move(ids));
  commands_.push_back(std::move(command));
  return true;
}

int PartCommands::depth() const {
  int deepest = 0;
  for (const Command& command : commands_)
    if (const Item* layers = command.find("layers")) deepest = std::max(deepest, static_cast<int>(layers->number));
  return deepest;
}

PartAsked PartCommands::asked(std::size_t i, LocalMesh& local, const GlobalIds& ids, bool has_cad) const {
  PartAsked result;
  result.asked.is_here = false;
  Session session;
  Session::Core& core = session.core();
  core.history.on = false;
  core.state.has_cad = has_cad;
  Command command = commands_[i];
  Mesh& mesh = local.meshed.mesh;
  mesh.node_ids = ids.node;
  mesh.hex_ids = ids.hex;
  bool is_any_left = !mesh.hexes.empty();  // a part may have none
  result.has_id.reserve(ids_[i].size());
  for (Item& item : command.items) {
    if (item.is_word || item.name != "range") continue;
    for (const NamedId& named : ids_[i])
      result.has_id.push_back((item.kind == EntityKind::node ? find_node(mesh, named.id) : find_hex(mesh, named.id)) >=
                              0);
    is_any_left = is_any_left && keep_ids_here(mesh, item.kind, item.range);
  }
  core.exchange_mesh(MeshHolder(std::move(local.meshed)));
  try {
    for (const auto& [before, function] : functions_) {
      if (before > i) break;
      Execution define(core, function);
      transact(define, [&] { execute(define); });
    }
    Execution run(core, command);
    if (is_any_left)
      find_target(run, result);
    else
      result.nothing = "none of them is there";
    const bool is_for_sizes = command.find("size") || command.has("sizing_function");
    const Item* range = command.find("range");
    // Entities of the mesh may all be elsewhere; those of the CAD are known to all.
    if (is_for_sizes && !result.has_target && range && is_mesh(range->kind)) ask_without_target(core, command, result);
  } catch (const NeedsWhole& needs) {
    result.by_whole = needs.why;
  } catch (const std::exception& error) {
    result.wrong = in_one_line(error);
  }
  local.meshed = std::move(core.meshed.to_change());
  local.meshed.mesh.node_ids.clear();
  local.meshed.mesh.hex_ids.clear();
  return result;
}

bool PartCommands::cuts_levels(std::size_t i, Approach approach) const {
  return approach == Approach::levels || (approach >= Approach::size_by_levels && approach <= Approach::nearest_size) ||
         (approach == Approach::trisect && !commands_[i].has("fill") && !commands_[i].has("nested"));
}

void PartCommands::check(std::size_t i, bool is_anywhere, const Objections& said, std::span<const std::int64_t> has_id,
                         Approach approach, std::span<const Approach> before) const {
  if (!said.wrong.empty()) throw Error(said.wrong);
  // Before the ids: parts that come behind the first objection are not asked which they have.
  if (!said.by_whole.empty()) throw NeedsWhole(said.by_whole);
  for (std::size_t k = 0; k < has_id.size(); ++k)
    if (has_id[k] == 0 && !ids_[i][k].may_be_missing) {
      if (ids_[i][k].is_end) refuse("a span of ids whose end is not there", "there may be ids beyond");
      throw Error("there is no " + std::string(name(commands_[i].find("range")->kind)) + " " +
                  std::to_string(ids_[i][k].id));
    }
  if (!is_anywhere) throw Error(said.nothing);
  if (!before.empty() && cuts_levels(i, approach) && cuts_levels(i - 1, before.back()))
    refuse("a second level", "it is made from the mesh before the first; 'numsplit 2' or 'transition nested' can be");
}

}  // namespace hextwist
