// What it takes to make one mesh from another, without copies of what is the same.
//
// An array is told from another by the pieces that differ. That finds nodes that moved (the same places), hexes that
// were split (gone from the middle, children at the end) and members that joined a set; where nothing fits, the array
// is kept whole.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "hextwist/base/same_bits.h"
#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// How to make the array `to` from the array `from`. Items are compared bit by bit.
class ArrayDelta {
 public:
  template <class T>
  ArrayDelta(const std::vector<T>& from, const std::vector<T>& to);
  /// Precondition: the `from` it was made with.
  template <class T>
  std::vector<T> apply(const std::vector<T>& from) const;
  bool empty() const { return same_; }
  /// Of memory held.
  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece) + fresh_.capacity(); }

 private:
  /// First n_fresh new items, then n_kept of `from`, beginning at first.
  struct Piece {
    std::size_t n_fresh, first, n_kept;
  };
  /// What to do where the two arrays differ.
  enum class Walk {
    replace,  ///< step on in both: values changed
    insert,   ///< step on in `to`: it has items that `from` has not
    drop,     ///< step on in `from`: it has items that `to` has not
  };
  template <class T, class F>
  static void walk(Walk how, const std::vector<T>& from, const std::vector<T>& to, F piece);

  bool same_;
  std::vector<Piece> pieces_;
  std::vector<std::byte> fresh_;
};

/// Of some or all arrays of a mesh and its association.
struct ArraysDelta {
  Mesh heads;                    ///< groups and fields of `to`, without members and values
  std::vector<ArrayDelta> each;  ///< in the order in which they are visited (mesh/arrays.h)
  std::size_t bytes = 0;         ///< of memory held for what differs
};
inline std::size_t bytes_of(const ArraysDelta& delta) {
  return delta.bytes;
}

/// The groups of a mesh: their own arrays only.
using SetsDelta = ArraysDelta;
SetsDelta sets_delta(const Mesh& from, const Mesh& to);
/// The three lists of `to`; the rest of the result is empty.
Mesh sets_after(const SetsDelta& delta, const Mesh& from);

/// Everything of a MeshedModel but its model, which is kept.
struct MeshedDelta {
  ArraysDelta arrays;
  std::shared_ptr<const Model> model;

  static MeshedDelta between(const MeshedModel& from, const MeshedModel& to);
  /// Precondition: the `from` it was made with.
  MeshedModel apply(const MeshedModel& from) const;
  std::size_t bytes() const { return arrays.bytes; }
};

/// Bytes in the arrays of a mesh and its association.
std::size_t bytes_of(const MeshedModel& meshed);
std::size_t bytes_of(const Association& association);
template <class T>
std::size_t bytes_of(const std::vector<T>& array) {
  return array.size() * sizeof(T);
}

/// Calls piece(begin of fresh items in `to`, their number, begin of kept items in `from`, their number) until it
/// returns false.
template <class T, class F>
void ArrayDelta::walk(Walk how, const std::vector<T>& from, const std::vector<T>& to, F piece) {
  std::size_t i = 0, j = 0;
  while (j < to.size()) {
    const std::size_t fresh = j;
    std::size_t ahead = i;
    const auto differ = [&] { return ahead >= from.size() || !same_bits(from[ahead], to[j]); };
    if (how == Walk::drop) {
      while (ahead < from.size() && differ()) ++ahead;
      if (ahead == from.size()) {
        j = to.size();  // the rest is new
      } else {
        i = ahead;
      }
    } else {
      for (; j < to.size() && differ(); ++j)
        if (how == Walk::replace) ++ahead;
      i = ahead;
    }
    const std::size_t n_fresh = j - fresh, kept = std::min(i, from.size()), begin = j;
    while (j < to.size() && i < from.size() && same_bits(from[i], to[j])) ++i, ++j;
    if (!piece(fresh, n_fresh, kept, j - begin)) return;
  }
}

template <class T>
ArrayDelta::ArrayDelta(const std::vector<T>& from, const std::vector<T>& to) : same_(same_bits(from, to)) {
  if (same_) return;
  Walk best = Walk::replace;
  std::size_t least = static_cast<std::size_t>(-1), n_pieces = 0, n_fresh = 0;
  for (const Walk how : {Walk::replace, Walk::insert, Walk::drop}) {
    std::size_t pieces = 0, fresh = 0;
    const auto cost = [&] { return pieces * sizeof(Piece) + fresh * sizeof(T); };
    walk(how, from, to, [&](std::size_t, std::size_t n, std::size_t, std::size_t) {
      ++pieces;
      fresh += n;
      return cost() < least;
    });
    if (cost() >= least) continue;
    best = how;
    least = cost();
    n_pieces = pieces;
    n_fresh = fresh;
  }
  pieces_.reserve(n_pieces);
  fresh_.reserve(n_fresh * sizeof(T));
  walk(best, from, to, [&](std::size_t first_fresh, std::size_t n, std::size_t first, std::size_t n_kept) {
    const auto* const items = reinterpret_cast<const std::byte*>(to.data() + first_fresh);
    fresh_.insert(fresh_.end(), items, items + n * sizeof(T));
    pieces_.push_back({n, first, n_kept});
    return true;
  });
}

template <class T>
std::vector<T> ArrayDelta::apply(const std::vector<T>& from) const {
  if (same_) return from;
  std::size_t size = 0;
  for (const Piece& piece : pieces_) size += piece.n_fresh + piece.n_kept;
  std::vector<T> result;
  result.reserve(size);
  const std::byte* fresh = fresh_.data();
  for (const Piece& piece : pieces_) {
    const std::size_t n = result.size(), bytes = piece.n_fresh * sizeof(T);
    result.resize(n + piece.n_fresh);
    if (bytes > 0) std::memcpy(static_cast<void*>(result.data() + n), fresh, bytes);
    fresh += bytes;
    const auto kept = from.begin() + static_cast<std::ptrdiff_t>(piece.first);
    result.insert(result.end(), kept, kept + static_cast<std::ptrdiff_t>(piece.n_kept));
  }
  return result;
}

}  // namespace hextwist
