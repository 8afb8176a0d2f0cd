// hextwist_read_cad: reads a CAD file behind a fence (base/fence.h) and hands it to who started it.
#include <unistd.h>

#include "hextwist/geom/occ/fenced_cad.h"

int main(int argc, char** argv) {
  // What libraries do at the end is of no use to anybody.
  _exit(hextwist::serve_fenced(argc, argv, hextwist::occ::serve_cad));
}
