// MSC Nastran Quick Reference Guide, "Bulk Data Entries".
#include "hextwist/io/nastran/others.h"

#include <algorithm>

namespace hextwist::io {
namespace {

constexpr NastranOther nastran_other_cards[] = {
    {"CQUAD4", OtherShape::quad, 2, 1, {4, 4}},      {"CQUADR", OtherShape::quad, 2, 1, {4, 4}},
    {"CSHEAR", OtherShape::quad, 2, 1, {4, 4}},      {"CQUAD8", OtherShape::quad, 2, 1, {8, 8}},
    {"CTRIA3", OtherShape::triangle, 2, 1, {3, 3}},  {"CTRIAR", OtherShape::triangle, 2, 1, {3, 3}},
    {"CTRIA6", OtherShape::triangle, 2, 1, {6, 6}},  {"CTETRA", OtherShape::tetrahedron, 2, 1, {4, 10}},
    {"CPYRAM", OtherShape::pyramid, 2, 1, {5, 13}},  {"CPENTA", OtherShape::wedge, 2, 1, {6, 15}},
    {"CBAR", OtherShape::line, 2, 1, {2, 2}},        {"CBEAM", OtherShape::line, 2, 1, {2, 2}},
    {"CBEND", OtherShape::line, 2, 1, {2, 2}},       {"CROD", OtherShape::line, 2, 1, {2, 2}},
    {"CTUBE", OtherShape::line, 2, 1, {2, 2}},       {"CONROD", OtherShape::line, 1, 0, {2, 2}},
    {"CONM1", OtherShape::point, 1, 0, {1, 1}},      {"CONM2", OtherShape::point, 1, 0, {1, 1}},
    {"CBUSH", OtherShape::connector, 2, 1, {0, 0}},  {"CGAP", OtherShape::connector, 2, 1, {0, 0}},
    {"CVISC", OtherShape::connector, 2, 1, {0, 0}},  {"CELAS1", OtherShape::connector, 2, 1, {0, 0}},
    {"CELAS2", OtherShape::connector, 2, 0, {0, 0}}, {"CDAMP1", OtherShape::connector, 2, 1, {0, 0}},
    {"CDAMP2", OtherShape::connector, 2, 0, {0, 0}}, {"CMASS1", OtherShape::connector, 2, 1, {0, 0}},
    {"CMASS2", OtherShape::connector, 2, 0, {0, 0}}, {"PLOTEL", OtherShape::connector, 1, 0, {0, 0}},
    {"RBE2", OtherShape::connector, 1, 0, {0, 0}},   {"RBAR", OtherShape::connector, 1, 0, {0, 0}},
};

bool is_integer_field(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

const NastranOther* nastran_other(std::string_view name) {
  const auto at = std::ranges::find(nastran_other_cards, name, &NastranOther::name);
  return at == std::end(nastran_other_cards) ? nullptr : &*at;
}

std::size_t nastran_place(const NastranOther& card, std::size_t n_nodes, std::size_t node) {
  if (card.shape != OtherShape::wedge || n_nodes != 15 || node < 9) return node;
  return node < 12 ? node + 3 : node - 3;
}

std::vector<std::size_t> nastran_node_fields(const NastranCard& card) {
  std::vector<std::size_t> fields;
  const auto add = [&](std::size_t field) {
    if (is_integer_field(card[field])) fields.push_back(field);
  };
  if (card.name == "RBE2") {
    add(1);
    for (std::size_t i = 3; i < card.fields.size(); ++i) add(i);
  } else if (card.name == "CBUSH" || card.name == "CGAP" || card.name == "CVISC") {
    add(2), add(3);
  } else if (card.name == "PLOTEL" || card.name == "RBAR") {
    add(1), add(2);
  } else {
    add(2), add(4);  // with components between
  }
  return fields;
}

bool is_rigid_card(const NastranCard& card) {
  const auto any = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last; ++i)
      if (!card[i].empty()) return true;
    return false;
  };
  if (card.name == "CBAR" || card.name == "CBEAM") return any(8, 9);
  if (card.name == "CQUAD4" || card.name == "CQUADR") return any(8, 13);
  return false;
}

}  // namespace hextwist::io
