// Cards of an Abaqus file that are no mesh: which of their words name parts of it, and their way into another file.
#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

using Named = AbaqusNamed;

struct Parameter {
  std::string_view name;
  Named::Kind kind;
};
/// Of keywords. All other parameters are not about the mesh.
constexpr Parameter parameters[] = {
    {"ELSET", Named::elements}, {"HOST ELSET", Named::elements}, {"NSET", Named::nodes},
    {"TIE NSET", Named::nodes}, {"PIN NSET", Named::nodes},      {"TIED NSET", Named::nodes},
    {"NODE SET", Named::nodes}, {"REF NODE", Named::nodes},      {"ROT NODE", Named::nodes},
    {"NODE", Named::nodes},     {"SURFACE", Named::surface},     {"MASTER", Named::surface},
    {"SLAVE", Named::surface},  {"MAIN", Named::surface},        {"SECONDARY", Named::surface},
    {"ADJUST", Named::node_set}};

/// Keywords whose data lines begin with names, and with how many.
struct DataNames {
  std::string_view keyword;
  Named::Kind kind;
  int n = 1;
  std::string_view type = {};  ///< only where TYPE= is this
};
constexpr int all = 100;  // of a line
/// Of one keyword the first that fits.
constexpr DataNames data_names[] = {{"BOUNDARY", Named::nodes},
                                    {"CLOAD", Named::nodes},
                                    {"CFLUX", Named::nodes},
                                    {"TEMPERATURE", Named::nodes},
                                    {"FIELD", Named::nodes},
                                    {"INITIAL CONDITIONS", Named::elements, 1, "STRESS"},
                                    {"INITIAL CONDITIONS", Named::elements, 1, "PLASTIC STRAIN"},
                                    {"INITIAL CONDITIONS", Named::elements, 1, "HARDENING"},
                                    {"INITIAL CONDITIONS", Named::elements, 1, "SOLUTION"},
                                    {"INITIAL CONDITIONS", Named::surface, 2, "CONTACT"},
                                    {"INITIAL CONDITIONS", Named::nodes},
                                    {"TRANSFORM", Named::nodes, 0},
                                    {"KINEMATIC COUPLING", Named::nodes},
                                    {"DISTRIBUTING COUPLING", Named::nodes},
                                    {"RETAINED NODAL DOFS", Named::nodes},
                                    {"DESIGN VARIABLES", Named::nodes},
                                    {"CLEARANCE", Named::nodes},
                                    {"CFILM", Named::nodes},
                                    {"CRADIATE", Named::nodes},
                                    {"CECHARGE", Named::nodes},
                                    {"CECURRENT", Named::nodes},
                                    {"DESIGNVARIABLES", Named::nodes},
                                    {"ADAPTIVE MESH CONSTRAINT", Named::nodes},
                                    {"NODAL ENERGY RATE", Named::nodes},
                                    {"PRESSURE PENETRATION", Named::nodes},
                                    {"SUBMODEL", Named::surface, all, "SURFACE"},
                                    {"SUBMODEL", Named::nodes, all},
                                    {"DLOAD", Named::elements},
                                    {"DFLUX", Named::elements},
                                    {"FILM", Named::elements},
                                    {"RADIATE", Named::elements},
                                    {"RELEASE", Named::elements},
                                    {"MASS FLOW", Named::elements},
                                    {"MASSFLOW", Named::elements},
                                    {"MASS ADJUST", Named::elements},
                                    {"FOUNDATION", Named::elements},
                                    {"BOUNDARYF", Named::elements},
                                    {"FLOW", Named::elements},
                                    {"DFLOW", Named::elements},
                                    {"DECHARGE", Named::elements},
                                    {"DECURRENT", Named::elements},
                                    {"IMPEDANCE", Named::elements},
                                    {"CONNECTOR LOAD", Named::elements},
                                    {"CONNECTOR MOTION", Named::elements},
                                    {"EMBEDDED ELEMENT", Named::elements, all},
                                    {"MODEL CHANGE", Named::surface, 2, "CONTACT PAIR"},
                                    {"MODEL CHANGE", Named::elements, all},
                                    {"DSLOAD", Named::surface},
                                    {"DSFLUX", Named::surface},
                                    {"SFILM", Named::surface},
                                    {"SFLOW", Named::surface},
                                    {"DSFLOW", Named::surface},
                                    {"DSECHARGE", Named::surface},
                                    {"DSECURRENT", Named::surface},
                                    {"SIMPEDANCE", Named::surface},
                                    {"INCIDENT WAVE", Named::surface},
                                    {"SRADIATE", Named::surface},
                                    {"SURFACE PROPERTY ASSIGNMENT", Named::surface},
                                    {"TIE", Named::surface, 2},
                                    {"SHELL TO SOLID COUPLING", Named::surface, 2},
                                    {"CONTACT PAIR", Named::surface, 2},
                                    {"CONTACT INCLUSIONS", Named::surface, 2},
                                    {"CONTACT EXCLUSIONS", Named::surface, 2},
                                    {"CONTACT INTERFERENCE", Named::surface, 2},
                                    {"CONTACT FORMULATION", Named::surface, 2},
                                    {"CONTACT PROPERTY ASSIGNMENT", Named::surface, 2},
                                    {"CONTACT INITIALIZATION ASSIGNMENT", Named::surface, 2},
                                    {"CONTACT CONTROLS ASSIGNMENT", Named::surface, 2},
                                    {"CONTACT CLEARANCE ASSIGNMENT", Named::surface, 2}};

/// How the data lines of a card begin, nullptr: not with names.
const DataNames* names_of(const AbaqusRawCard& card) {
  const std::string type = parameter_of(card.text, "TYPE");
  const auto* found = std::ranges::find_if(data_names, [&](const DataNames& of) {
    return of.keyword == card.keyword && (of.type.empty() || of.type == type);
  });
  return found == std::end(data_names) ? nullptr : found;
}

/// Cards whose data lines go on with a face of the elements: letters, its number, and other letters.
struct FaceLabel {
  std::string_view keyword, letters;
};
constexpr FaceLabel face_labels[] = {{"DLOAD", "P"},      {"DLOAD", "HP"},    {"DLOAD", "TRVEC"}, {"DLOAD", "TRSHR"},
                                     {"DLOAD", "VP"},     {"DLOAD", "SP"},    {"DFLUX", "S"},     {"FILM", "F"},
                                     {"RADIATE", "R"},    {"MASS FLOW", "M"}, {"MASSFLOW", "M"},  {"FOUNDATION", "F"},
                                     {"BOUNDARYF", "F"},  {"FLOW", "Q"},      {"DFLOW", "S"},     {"DECHARGE", "ES"},
                                     {"DECURRENT", "CS"}, {"IMPEDANCE", "I"}};

/// How many letters a label of a face begins with, 0: it is none.
std::size_t letters_of_face(std::string_view keyword, const std::string& label) {
  for (const FaceLabel& of : face_labels) {
    const std::size_t n = of.letters.size();
    if (of.keyword == keyword && label.size() > n && label.starts_with(of.letters) && label[n] >= '1' &&
        label[n] <= '6' && (label.size() == n + 1 || std::isalpha(static_cast<unsigned char>(label[n + 1]))))
      return n;
  }
  return 0;
}

}  // namespace

std::string parameter_of(std::string_view text, std::string_view parameter) {
  std::string_view rest = text.substr(0, text.find('\n'));
  while (!rest.empty()) {
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    const auto equals = item.find('=');
    if (equals != std::string_view::npos && same_word(trimmed(item.substr(0, equals)), parameter))
      return upper_case(trimmed(item.substr(equals + 1)));
  }
  return {};
}

bool has_faces(std::string_view keyword) {
  return std::ranges::find(face_labels, keyword, &FaceLabel::keyword) != std::end(face_labels);
}

AbaqusFaceLoad abaqus_face_load(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  const std::string_view before = trimmed(std::string_view(text).substr(0, comma)),
                         label = trimmed(std::string_view(text).substr(comma + 1));
  const std::size_t digit = label.find_first_of("123456");
  AbaqusFaceLoad load{std::string(before), std::string(label.substr(0, digit)), std::string(label.substr(digit + 1)),
                      label[digit] - '0', before.size()};
  std::erase(load.elements, '"');
  return load;
}

bool depends_on_numbers(std::string_view keyword) {
  constexpr std::string_view cards[] = {"DISTRIBUTION", "NODAL THICKNESS", "NORMAL", "IMPERFECTION", "EQUATION", "MPC"};
  return std::ranges::find(cards, keyword) != std::end(cards);
}

std::string what_does_not_follow(const AbaqusRawCard& card) {
  const auto has = [&](std::string_view word) {
    return upper_case(std::string_view(card.text).substr(0, card.text.find('\n'))).find(word) != std::string::npos;
  };
  if (card.keyword == "SOLID SECTION" && (has("COMPOSITE") || has("STACK DIRECTION")))
    return "has layers along a direction of the elements; that of hexes that a refinement makes may be another one";
  if (card.keyword == "ORIENTATION" && parameter_of(card.text, "DEFINITION") == "OFFSET TO NODES")
    return "counts from nodes of the elements; those of hexes that a refinement makes may be others";
  if (card.keyword == "ORIENTATION" && parameter_of(card.text, "DEFINITION") == "NODES")
    return "names nodes by number: these stay as they are";
  for (const char* file : {"INPUT", "FILE"})
    if (const std::string name = parameter_of(card.text, file); !name.empty() && names_of(card))
      return "reads " + name + ", which is not read here: numbers of nodes and elements in it stay as they are";
  return {};
}

void find_names(AbaqusRawCard& card) {
  card.named.clear();
  const std::string& text = card.text;
  const auto add = [&](Named::Kind kind, std::size_t begin, std::size_t end, bool by_keyword) {
    while (begin < end && Cursor::blank(text[begin])) ++begin;
    while (begin < end && Cursor::blank(text[end - 1])) --end;
    if (begin < end) card.named.push_back({kind, begin, end, by_keyword});
  };
  bool keyword_line = true;
  const DataNames* const data = names_of(card);
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
      } else if (data && column < data->n) {
        add(data->kind, word, end, false);
      } else if (column == 1 && !card.named.empty() && card.named.back().begin >= line &&
                 letters_of_face(card.keyword, upper_case(trimmed(std::string_view(text).substr(word, end - word)))) >
                     0) {
        card.named.back().kind = Named::faces;
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
