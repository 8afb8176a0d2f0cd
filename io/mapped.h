// Files as memory, which survives that somebody shortens them.
//
// Where a page of a mapped file is no more, the system sends SIGBUS to who reads it. While a file is mapped here, such
// a signal puts zeros in place of what is gone and leaves a mark. Other signals of that kind go to whom they went
// before.
#pragma once

#include <cstddef>

namespace hextwist::io {

/// Null where the system can't. size > 0.
const char* map(int descriptor, std::size_t size);
void unmap(const char* data, std::size_t size);
/// Is the file another one by now, as far as size, time and what has been read of it tell?
bool has_changed(const char* data);

}  // namespace hextwist::io
