// Nastran's bulk data: cards of fields (MSC Nastran Quick Reference Guide, "Bulk Data Entries", "Format").
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// The 20 nodes of a CHEXA: middle nodes of the lower ring, the pillars, the upper ring.
inline constexpr const MiddleOrder& nastran_middles = exodus_middles;

/// A card with its continuations: the fields behind its name, blanks trimmed.
struct NastranCard {
  std::string name;  ///< upper case, without '*'
  std::vector<std::string> fields;
  const char* at;

  const std::string& operator[](std::size_t i) const {
    static const std::string blank;
    return i < fields.size() ? fields[i] : blank;
  }
};

/// Reads the next card of the bulk data, in small fields (8 characters), large ones (16, '*') or free (commas); name
/// empty at the end. Comments go to `comment`, with their place.
class NastranCards {
 public:
  explicit NastranCards(Cursor& cursor) : cursor_(cursor) {}
  NastranCard next(const std::function<void(std::string_view, const char*)>& comment);
  /// Cards in free fields with something behind the last field, where only the mark of a continuation may stand, and no
  /// continuation: how many, the first of them and what stands there.
  struct Overfull {
    std::int64_t n = 0;
    std::string name, text;
    const char* at = nullptr;
  };
  const Overfull& overfull() const { return overfull_; }

 private:
  struct Line {
    std::string name;
    std::vector<std::string> fields;
    std::string behind;  ///< the mark of a continuation and what follows it, in free fields
    bool continues = false;
  };
  Line split(std::string_view text) const;
  void finish(const NastranCard& card, const std::string& behind);
  Cursor& cursor_;
  Overfull overfull_;
};

/// A number in so many characters, with a point, as near as it gets: "1.5-7".
std::string nastran_real(double value, std::size_t width);

}  // namespace hextwist::io
