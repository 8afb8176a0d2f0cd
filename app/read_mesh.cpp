// hextwist_read_mesh: reads a mesh file by the library of its format behind a fence (base/fence.h) and hands the mesh
// to who started it.
#include <unistd.h>

#include "hextwist/io/apart.h"

int main(int argc, char** argv) {
  // What libraries do at the end is of no use to anybody.
  _exit(hextwist::serve_fenced(argc, argv, hextwist::io::serve_mesh));
}
