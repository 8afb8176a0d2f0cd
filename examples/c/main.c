/* Adaptive analysis in C: adapt part.brep part.msh refined.vtu
 *
 * A solver would compute how large the error of each hex is; here it is large near the origin. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "hextwist/embed/c.h"

static int fail(void) {
  fprintf(stderr, "%s\n", hextwist_error());
  return 1;
}

/* The wished size of a hex: a twentieth of how far its middle is from the origin, but not below 2. */
static double wish(const double* points, const int32_t* hex) {
  double middle[3] = {0, 0, 0}, distance = 0;
  for (int c = 0; c < 8; ++c)
    for (int k = 0; k < 3; ++k) middle[k] += points[3 * hex[c] + k] / 8;
  for (int k = 0; k < 3; ++k) distance += middle[k] * middle[k];
  return fmax(2, sqrt(distance) / 20);
}

int main(int argc, char** argv) {
  if (argc != 4) {
    fprintf(stderr, "usage: adapt CAD MESH OUTPUT\n");
    return 2;
  }
  char command[4096];
  hextwist_session* session = hextwist_create();
  snprintf(command, sizeof command, "import geometry \"%s\"\nimport mesh \"%s\"", argv[1], argv[2]);
  if (hextwist_run(session, command)) return fail();

  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const int64_t n = hextwist_n_hexes(mesh);
  const double* points = hextwist_points(mesh);
  const int32_t* hexes = hextwist_hexes(mesh);
  double* sizes = malloc((size_t)n * sizeof *sizes);
  for (int64_t h = 0; h < n; ++h) sizes[h] = wish(points, hexes + 8 * h);

  int32_t* origin = NULL; /* per new hex: the old one that it lies in, to carry a solution over */
  if (hextwist_adapt_sizes(session, sizes, n, NULL, &origin)) return fail();
  hextwist_mesh* adapted = hextwist_mesh_of(session);
  printf("%lld hexes became %lld\n", (long long)n, (long long)hextwist_n_hexes(adapted));

  snprintf(command, sizeof command, "export mesh \"%s\" overwrite", argv[3]);
  if (hextwist_run(session, command)) return fail();
  hextwist_free_array(origin);
  free(sizes);
  hextwist_mesh_free(mesh);
  hextwist_mesh_free(adapted);
  hextwist_free(session);
  return 0;
}
