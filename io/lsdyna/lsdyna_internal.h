// LS-DYNA's keyword input: keywords, and below each its data cards (LS-DYNA Keyword User's Manual, volume I, "Getting
// started", "General card format").
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// Middle nodes of *ELEMENT_SOLID_H20: the lower ring, the upper ring, the pillars.
inline constexpr const MiddleOrder& lsdyna_middles = vtk_middles;

/// The title of files that we write.
inline constexpr std::string_view lsdyna_title = "hextwist mesh";

/// A data card: fields of fixed width, or between commas.
struct DynaCard {
  static constexpr std::size_t most = 24;  // of more no card of a mesh makes use
  std::array<std::string_view, most> fields;
  std::size_t n = 0;
  const char* at = nullptr;
  std::string_view text;  ///< the whole line

  std::string_view operator[](std::size_t i) const { return i < n ? fields[i] : std::string_view(); }
  /// Fields up to the last that is not blank.
  std::size_t filled() const;
  /// Is one of these fields something other than blank or 0?
  bool any(std::size_t first, std::size_t last) const;
};

/// Widths of the fields of a card: the first, then all others up to `n`, of which the last `n_last` are as the first.
struct DynaWidths {
  std::size_t first, others, n, n_last = 0;
};
inline constexpr DynaWidths dyna_node{8, 16, 6, 2}, dyna_element{8, 8, 10}, dyna_set{10, 10, 8};

/// Keywords one by one, and the cards of the one at hand. Comments are skipped.
class DynaCards {
 public:
  explicit DynaCards(Cursor& cursor) : cursor_(cursor) {}

  /// Goes to the next keyword, upper case, without '*'; empty at the end of the file.
  const std::string& next_keyword();
  const std::string& keyword() const { return keyword_; }
  const char* keyword_at() const { return keyword_at_; }
  /// The next card of this keyword; false where there is none. Blank lines are cards of their own for titles alone.
  bool next(DynaCard& card, const DynaWidths& widths);
  bool next_title(std::string& title);

  std::int64_t integer(const DynaCard& card, std::size_t field, const char* what) const;
  /// Between 0 and the largest int.
  int id(const DynaCard& card, std::size_t field, const char* what) const;
  double real(const DynaCard& card, std::size_t field) const;

 private:
  bool next_line(std::string_view& line, const char*& at);
  Cursor& cursor_;
  std::string keyword_;
  const char* keyword_at_ = nullptr;
  bool all_long_ = false, all_ten_ = false;  // *KEYWORD LONG=Y, I10=Y
  bool long_ = false, ten_ = false;          // of this keyword
};

}  // namespace hextwist::io
