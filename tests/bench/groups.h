// Each file of benchmarks registers its own.
#pragma once

namespace hextwist::bench {

void add_split();
void add_small_change();
void add_associate();
void add_place();
void add_smooth();
void add_quality();
void add_files();
void add_memory();
void add_front();
void add_session();
// With more threads; these come last, for idle threads spin for a while.
void add_split_threads();
void add_associate_threads();
void add_place_threads();

}  // namespace hextwist::bench
