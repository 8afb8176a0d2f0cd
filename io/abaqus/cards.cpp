// Cards of an Abaqus file that are no mesh: which of their words name parts of it, and their way into another file.
#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

struct Parameter {
  std::string_view name;
  AbaqusNamed::Kind kind;
};
/// Of keywords. All other parameters are not about the mesh.
constexpr Parameter parameters[] = {{"ELSET", AbaqusNamed::elements}, {"NSET", AbaqusNamed::nodes},
                                    {"TIE NSET", AbaqusNamed::nodes}, {"PIN NSET", AbaqusNamed::nodes},
                                    {"REF NODE", AbaqusNamed::nodes}, {"ROT NODE", AbaqusNamed::nodes},
                                    {"SURFACE", AbaqusNamed::surface}};

/// Keywords whose data lines begin with names, and with how many.
struct DataNames {
  std::string_view keyword;
  AbaqusNamed::Kind kind;
  int n = 1;
};
constexpr DataNames data_names[] = {{"BOUNDARY", AbaqusNamed::nodes},
                                    {"CLOAD", AbaqusNamed::nodes},
                                    {"CFLUX", AbaqusNamed::nodes},
                                    {"TEMPERATURE", AbaqusNamed::nodes},
                                    {"FIELD", AbaqusNamed::nodes},
                                    {"INITIAL CONDITIONS", AbaqusNamed::nodes},
                                    {"TRANSFORM", AbaqusNamed::nodes, 0},
                                    {"DLOAD", AbaqusNamed::elements},
                                    {"DFLUX", AbaqusNamed::elements},
                                    {"FILM", AbaqusNamed::elements},
                                    {"RADIATE", AbaqusNamed::elements},
                                    {"DSLOAD", AbaqusNamed::surface},
                                    {"DSFLUX", AbaqusNamed::surface},
                                    {"SFILM", AbaqusNamed::surface},
                                    {"SRADIATE", AbaqusNamed::surface},
                                    {"TIE", AbaqusNamed::surface, 2},
                                    {"CONTACT PAIR", AbaqusNamed::surface, 2},
                                    {"CONTACT INCLUSIONS", AbaqusNamed::surface, 2},
                                    {"CONTACT EXCLUSIONS", AbaqusNamed::surface, 2}};

/// Cards whose data lines go on with a face of the elements: a letter and its number.
struct FaceLetter {
  std::string_view keyword;
  char letter;
};
constexpr FaceLetter face_letters[] = {{"DLOAD", 'P'}, {"DFLUX", 'S'}, {"FILM", 'F'}, {"RADIATE", 'R'}};

bool is_face(std::string_view keyword, const std::string& label) {
  const auto* of = std::ranges::find(face_letters, keyword, &FaceLetter::keyword);
  return of != std::end(face_letters) && label.size() >= 2 && label[0] == of->letter && label[1] >= '1' &&
         label[1] <= '6' && (label.size() == 2 || std::isalpha(static_cast<unsigned char>(label[2])));
}

}  // namespace

AbaqusFaceLoad abaqus_face_load(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  AbaqusFaceLoad load{std::string(trimmed(text.substr(0, comma))), std::string(trimmed(text.substr(comma + 1))), 0};
  load.face = load.label[1] - '0';
  return load;
}

bool depends_on_numbers(std::string_view keyword) {
  constexpr std::string_view cards[] = {"DISTRIBUTION", "NODAL THICKNESS", "NORMAL", "IMPERFECTION", "EQUATION", "MPC"};
  return std::ranges::find(cards, keyword) != std::end(cards);
}

void find_names(AbaqusRawCard& card) {
  const auto* data = std::ranges::find(data_names, card.keyword, &DataNames::keyword);
  const std::string& text = card.text;
  const auto add = [&](AbaqusNamed::Kind kind, std::size_t begin, std::size_t end, bool by_keyword) {
    while (begin < end && Cursor::blank(text[begin])) ++begin;
    while (begin < end && Cursor::blank(text[end - 1])) --end;
    if (begin < end) card.named.push_back({kind, begin, end, by_keyword});
  };
  bool keyword_line = true;
  const std::string first_line = upper_case(std::string_view(text).substr(0, text.find('\n')));
  bool by_element = false;  // stresses and the like
  for (const char* type : {"STRESS", "STRAIN", "HARDENING", "SOLUTION"})
    by_element = by_element || (card.keyword == "INITIAL CONDITIONS" && first_line.find(type) != std::string::npos);
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t line_end = text.find('\n', line);
    int column = 0;
    for (std::size_t word = line; word <= line_end; ++column) {
      std::size_t end = word;
      for (bool quotes = false; end < line_end && (quotes || text[end] != ','); ++end)
        if (text[end] == '"') quotes = !quotes;
      if (keyword_line) {
        if (const auto equals = text.find('=', word); equals < end) {
          const std::string name = upper_case(trimmed(std::string_view(text).substr(word, equals - word)));
          if (const auto* known = std::ranges::find(parameters, name, &Parameter::name); known != std::end(parameters))
            add(known->kind, equals + 1, end, true);
        }
      } else if (data != std::end(data_names) && column < data->n) {
        add(by_element ? AbaqusNamed::elements : data->kind, word, end, false);
      } else if (column == 1 && !card.named.empty() && card.named.back().begin >= line &&
                 is_face(card.keyword, upper_case(trimmed(std::string_view(text).substr(word, end - word))))) {
        card.named.back().kind = AbaqusNamed::faces;
        card.named.back().end = end;
      }
      word = end + 1;
    }
    keyword_line = keyword_line && trimmed(std::string_view(text).substr(line, line_end - line)).ends_with(',');
    line = line_end + 1;
  }
}

std::pair<std::size_t, std::size_t> line_around(std::string_view text, std::size_t at) {
  const auto before = text.rfind('\n', at);
  return {before == std::string_view::npos ? 0 : before + 1, text.find('\n', at) + 1};
}

void cut_out(AbaqusCard& card, std::size_t begin, std::size_t end) {
  card.text.erase(begin, end - begin);
  std::erase_if(card.references,
                [&](const auto& reference) { return reference.begin >= begin && reference.begin < end; });
  for (auto& reference : card.references)
    if (reference.begin >= end) reference.begin -= end - begin, reference.end -= end - begin;
}

}  // namespace hextwist::io
