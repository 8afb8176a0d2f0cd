// Systems of coordinates (Abaqus Keywords Guide, *ORIENTATION and *TRANSFORM) of parts, which stand where their
// instances do.
#include "hextwist/io/abaqus/abaqus_internal.h"
#include "hextwist/io/file.h"

namespace hextwist::io {
namespace {

std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> result;
  while (!line.empty()) {
    const auto end = std::min(line.find(','), line.size());
    const std::string_view word = trimmed(line.substr(0, end));
    line.remove_prefix(std::min(line.size(), end + 1));
    if (word.empty() && line.empty()) break;
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (!word.empty() && (error != std::errc{} || stop != word.data() + word.size())) return {};
    result.push_back(value);
  }
  return result;
}

/// The card with its first data line for the place; as it is where that says something else than coordinates.
void turn_system(const AbaqusPlaced& placed, AbaqusRawCard& card) {
  const std::string definition = parameter_of(card.text, "DEFINITION");
  if (!definition.empty() && definition != "COORDINATES") return;
  const std::string system = parameter_of(card.text, card.keyword == "TRANSFORM" ? "TYPE" : "SYSTEM");
  const bool has_axis = system.starts_with('C') || system.starts_with('S');  // cylindrical, spherical
  if (!has_axis && placed.turn.isIdentity(0)) return;
  const std::size_t begin = card.text.find('\n') + 1, end = std::min(card.text.find('\n', begin), card.text.size());
  const auto given = numbers_of(std::string_view(card.text).substr(begin, end - begin));
  if (!given || given->size() < 4) return;
  std::array<double, 9> x{};
  std::copy_n(given->begin(), std::min(given->size(), x.size()), x.begin());
  const Vec3 origin(x[6], x[7], x[8]);
  std::string line;
  for (const Vec3& point : {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])}) {
    Vec3 at = placed.turn * (has_axis ? point : point - origin);
    const double noise = 1e-15 * at.norm();
    for (double& each : at)
      if (std::abs(each) <= noise) each = 0;
    if (has_axis) at += placed.shift;
    for (const double each : at)
      line += (line.empty() ? "" : ", ") + std::string(NumberText(each, abaqus_number_width).text());
  }
  card.text.replace(begin, end - begin, line);
}

/// Words of a card that are this name: a parameter of the keyword, or in lines of a section or a connector.
void rename_system(AbaqusRawCard& card, const std::string& name, const std::string& now) {
  const bool in_lines = card.keyword.ends_with("SECTION");
  const std::size_t first_end = card.text.find('\n');
  for (std::size_t at = 0; at < card.text.size();) {
    std::size_t end = std::min(card.text.find_first_of(",\n", at), card.text.size());
    const std::string_view word = trimmed(std::string_view(card.text).substr(at, end - at));
    const auto equals = word.find('=');
    const bool is_parameter = equals != std::string_view::npos && at < first_end;
    const std::string_view parameter = is_parameter ? trimmed(word.substr(0, equals)) : std::string_view();
    const std::string_view value = is_parameter ? trimmed(word.substr(equals + 1)) : word;
    const bool is_system =
        same_word(parameter, "ORIENTATION") || (same_word(parameter, "NAME") && card.keyword == "ORIENTATION");
    if (same_word(value, name) && (is_parameter ? is_system : in_lines && at > first_end)) {
      const auto where = static_cast<std::size_t>(value.data() - card.text.data());
      card.text.replace(where, value.size(), now);
      end += now.size() - name.size();
    }
    at = end + 1;
  }
}

}  // namespace

bool belongs_to_last(const AbaqusRawCard& card) {
  return parameter_of(card.text, "NAME").empty();
}

std::vector<AbaqusRawCard> AbaqusCardsOfPlaces::of(const AbaqusContents& contents, const AbaqusPlaced& placed,
                                                   std::vector<std::string>& notices) {
  std::vector<AbaqusRawCard> cards;
  const bool has_moved = !placed.turn.isIdentity(0) || !placed.shift.isZero(0);
  std::vector<std::pair<std::string, std::string>> renamed;
  const AbaqusRawCard* with_directions = nullptr;
  for (const AbaqusScope* scope : placed.scopes) {
    if (!scope) continue;
    for (const AbaqusRawCard& card : scope->cards) {
      AbaqusRawCard& own = cards.emplace_back(card);
      const bool is_orientation = card.keyword == "ORIENTATION";
      if (has_moved && (is_orientation || card.keyword == "TRANSFORM")) turn_system(placed, own);
      constexpr std::string_view of_beams[] = {"BEAM SECTION", "BEAM GENERAL SECTION", "FRAME SECTION",
                                               "ROTARY INERTIA"};
      if (!placed.turn.isIdentity(0) && std::ranges::find(of_beams, card.keyword) != std::end(of_beams))
        with_directions = &card;
      const std::string name = parameter_of(card.text, "NAME");
      if (!is_orientation || name.empty()) continue;
      const auto [known, is_new] = systems_.try_emplace(name, own.text);
      if (is_new || known->second == own.text) continue;
      std::string other = placed.name + "_" + name;
      while (!systems_.try_emplace(upper_case(other), own.text).second) other += "_";
      renamed.emplace_back(name, other);
    }
  }
  if (with_directions)
    notices.push_back(contents.where(with_directions->at) + ": *" + with_directions->keyword +
                      " has directions of the part: they do not turn with instance '" + placed.name + "'");
  for (const auto& [name, other] : renamed)
    for (AbaqusRawCard& card : cards) rename_system(card, name, other);
  for (AbaqusRawCard& card : cards) find_names(card);
  return cards;
}

}  // namespace hextwist::io
