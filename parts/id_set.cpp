#include "hextwist/parts/id_set.h"

#include <algorithm>
#include <bit>

namespace hextwist {
namespace {

constexpr std::size_t width = 64;

std::uint64_t bit(std::int64_t id) {
  return std::uint64_t{1} << (static_cast<std::size_t>(id) % width);
}

}  // namespace

bool IdSet::add(std::int64_t id) {
  const std::size_t at = static_cast<std::size_t>(id) / ids_on_page;
  if (at >= pages_.size()) pages_.resize(at + 1);
  std::unique_ptr<Page>& page = pages_[at];
  if (!page) {
    page = std::make_unique<Page>();
    ++n_pages_;
  }
  std::uint64_t& word = page->bits[static_cast<std::size_t>(id) / width % words];
  if (word & bit(id)) return false;
  word |= bit(id);
  ++page->n;
  ++size_;
  highest_ = std::max(highest_, id);
  return true;
}

bool IdSet::has(std::int64_t id) const {
  const std::size_t at = static_cast<std::size_t>(id) / ids_on_page;
  return id >= 0 && at < pages_.size() && pages_[at] &&
         (pages_[at]->bits[static_cast<std::size_t>(id) / width % words] & bit(id));
}

bool IdSet::is_sparse() const {
  const std::int64_t bytes = n_pages_ * static_cast<std::int64_t>(sizeof(Page)) + 8 * std::ssize(pages_);
  return bytes > 8 * size_ + (std::int64_t{1} << 26);
}

std::vector<Index> IdSet::places(std::span<const std::int64_t> ids) const {
  std::vector<Index> result;
  result.reserve(ids.size());
  std::int64_t before = 0;  // ids on lower pages and in lower words
  std::size_t page = 0, word = 0;
  for (const std::int64_t id : ids) {
    if (!has(id)) {
      result.push_back(-1);
      continue;
    }
    const std::size_t to_page = static_cast<std::size_t>(id) / ids_on_page;
    const std::size_t to_word = static_cast<std::size_t>(id) / width % words;
    if (page < to_page && word > 0) {  // all of the page, not what is left of it
      for (; word > 0; --word) before -= std::popcount(pages_[page]->bits[word - 1]);
    }
    for (; page < to_page; ++page)
      if (pages_[page]) before += pages_[page]->n;
    for (; word < to_word; ++word) before += std::popcount(pages_[page]->bits[word]);
    result.push_back(static_cast<Index>(before + std::popcount(pages_[page]->bits[word] & (bit(id) - 1))));
  }
  return result;
}

std::int64_t IdSet::Walk::next() {
  const auto& pages = set_->pages_;
  while (page_ < pages.size()) {
    if (pages[page_]) {
      if (!is_begun_) {
        rest_ = pages[page_]->bits[word_];
        is_begun_ = true;
      }
      for (;;) {
        if (rest_) {
          const int low = std::countr_zero(rest_);
          rest_ &= rest_ - 1;
          return static_cast<std::int64_t>((page_ * words + word_) * width) + low;
        }
        if (++word_ == words) break;
        rest_ = pages[page_]->bits[word_];
      }
    }
    ++page_;
    word_ = 0;
    is_begun_ = false;
  }
  return -1;
}

}  // namespace hextwist
