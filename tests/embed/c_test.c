/* The C interface, used by a C compiler: every function, every kind of error, lifetimes. Arguments: the folder of the
 * models, a folder for output. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hextwist/embed/c.h"

static int n_failed = 0;
#define CHECK(condition)                                                                                            \
  do                                                                                                                \
    if (!(condition)) {                                                                                             \
      fprintf(stderr, "%s:%d: not true: %s\n  last error: %s\n", __FILE__, __LINE__, #condition, hextwist_error()); \
      ++n_failed;                                                                                                   \
    }                                                                                                               \
  while (0)

static const char* models;

static hextwist_session* bracket(void) {
  char text[2048];
  hextwist_session* session = hextwist_create();
  snprintf(text, sizeof text, "import brep '%s/bracket.brep'; import mesh '%s/bracket.msh'", models, models);
  CHECK(hextwist_run(session, text) == HEXTWIST_OK);
  return session;
}

/* Volume of a hex by its five tetrahedra around the corners 0 2 5 7 (VTK order). */
static double tetrahedron(const double* p, int32_t a, int32_t b, int32_t c, int32_t d) {
  double u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = p[3 * b + k] - p[3 * a + k];
    v[k] = p[3 * c + k] - p[3 * a + k];
    w[k] = p[3 * d + k] - p[3 * a + k];
  }
  return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
          u[2] * (v[0] * w[1] - v[1] * w[0])) /
         6;
}
static double volume(const hextwist_mesh* mesh) {
  const double* p = hextwist_points(mesh);
  double sum = 0;
  for (int64_t i = 0; i < hextwist_n_hexes(mesh); ++i) {
    const int32_t* h = hextwist_hexes(mesh) + 8 * i;
    sum += tetrahedron(p, h[0], h[1], h[2], h[5]) + tetrahedron(p, h[0], h[2], h[3], h[7]) +
           tetrahedron(p, h[0], h[5], h[7], h[4]) + tetrahedron(p, h[2], h[7], h[5], h[6]) +
           tetrahedron(p, h[0], h[2], h[7], h[5]);
  }
  return sum;
}

static void arrays_describe_the_mesh(void) {
  hextwist_session* session = bracket();
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const int64_t n_nodes = hextwist_n_nodes(mesh), n_hexes = hextwist_n_hexes(mesh);
  CHECK(n_hexes == 488 && n_nodes > 0);
  CHECK(fabs(volume(mesh) / 33256.637 - 1) < 0.01);
  static const int file_corner[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  int64_t n_in_volume = 0;
  for (int64_t h = 0; h < n_hexes; ++h) {
    for (int c = 0; c < 8; ++c)
      CHECK(hextwist_hexes(mesh)[8 * h + c] == hextwist_bit_hexes(mesh)[8 * h + file_corner[c]]);
    n_in_volume += hextwist_hex_volumes(mesh)[h] == 1;
    CHECK(hextwist_hex_ids(mesh)[h] == h + 1);
  }
  CHECK(n_in_volume == n_hexes);
  for (int64_t i = 0; i < n_nodes; ++i) CHECK(i == 0 || hextwist_node_ids(mesh)[i] > hextwist_node_ids(mesh)[i - 1]);
  CHECK(hextwist_n_entities(mesh, 3) == 1 && hextwist_n_entities(mesh, 4) == 0 && hextwist_n_entities(mesh, -1) == 0);
  CHECK(fabs(hextwist_entity_measure(mesh, 3, 1) / 33256.637 - 1) < 1e-6);
  CHECK(hextwist_entity_measure(mesh, 3, 2) == 0);
  /* Quads: normals look out of the part, so their fluxes make its volume (divergence theorem). */
  double flux = 0;
  const double* p = hextwist_points(mesh);
  for (int64_t q = 0; q < hextwist_n_surface_quads(mesh); ++q) {
    const int32_t* c = hextwist_surface_quads(mesh) + 4 * q;
    const int32_t* side = hextwist_surface_sides(mesh) + 2 * q;
    CHECK(side[0] >= 0 && side[0] < n_hexes && side[1] >= 0 && side[1] < 6);
    CHECK(hextwist_quad_surfaces(mesh)[q] >= 1 && hextwist_quad_surfaces(mesh)[q] <= hextwist_n_entities(mesh, 2));
    double a[3], b[3];
    for (int k = 0; k < 3; ++k) a[k] = p[3 * c[2] + k] - p[3 * c[0] + k], b[k] = p[3 * c[3] + k] - p[3 * c[1] + k];
    const double normal[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j) flux += normal[k] / 2 * p[3 * c[j] + k] / 4 / 3;
  }
  CHECK(fabs(flux / volume(mesh) - 1) < 0.01);
  for (int64_t e = 0; e < hextwist_n_curve_edges(mesh); ++e) {
    CHECK(hextwist_edge_curves(mesh)[e] >= 1);
    for (int k = 0; k < 2; ++k) {
      const int32_t node = hextwist_curve_edges(mesh)[2 * e + k];
      const int32_t* owner = hextwist_node_owners(mesh) + 2 * node;
      CHECK(owner[0] == 0 || (owner[0] == 1 && owner[1] == hextwist_edge_curves(mesh)[e]));
      CHECK(owner[0] != 1 || isfinite(hextwist_node_parameters(mesh)[2 * node]));
    }
  }
  double* shape = malloc((size_t)n_hexes * sizeof *shape);
  CHECK(hextwist_quality(mesh, "shape", shape) == HEXTWIST_OK);
  for (int64_t h = 0; h < n_hexes; ++h) CHECK(shape[h] > 0 && shape[h] <= 1 + 1e-12);
  CHECK(hextwist_quality(mesh, "beauty", shape) == HEXTWIST_FAILED && strstr(hextwist_error(), "beauty"));
  CHECK(hextwist_quality(mesh, NULL, shape) == HEXTWIST_FAILED);
  free(shape);
  hextwist_mesh_free(mesh);
  hextwist_free(session);
}

static void a_mesh_outlives_commands_and_its_session(void) {
  hextwist_session* session = bracket();
  CHECK(hextwist_run(session, "block 7 hex 1 to 5 name 'core'") == HEXTWIST_OK);
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const double volume_before = volume(mesh);
  const double* points = hextwist_points(mesh);
  const int64_t n_blocks = hextwist_n_groups(mesh, HEXTWIST_BLOCK);
  const hextwist_group core = hextwist_group_at(mesh, HEXTWIST_BLOCK, n_blocks - 1);
  CHECK(core.id == 7 && core.n == 5 && core.members[4] == 4 && strcmp(core.name, "core") == 0);
  CHECK(hextwist_run(session, "block 7 add hex 6 to 9; block 8 hex 10; refine hex 1; smooth volume all") ==
        HEXTWIST_OK);
  CHECK(hextwist_n_hexes(mesh) == 488 && hextwist_points(mesh) == points && volume(mesh) == volume_before);
  CHECK(hextwist_n_groups(mesh, HEXTWIST_BLOCK) == n_blocks && core.n == 5 && core.members[4] == 4);
  hextwist_mesh* after = hextwist_mesh_of(session);
  CHECK(hextwist_n_hexes(after) > 488 && hextwist_n_groups(after, HEXTWIST_BLOCK) == n_blocks + 1);
  hextwist_free(session);
  CHECK(volume(mesh) == volume_before && hextwist_n_hexes(after) > 488);
  hextwist_mesh_free(mesh);
  hextwist_mesh_free(after);
}

static void errors_say_what_is_wrong_and_where(void) {
  hextwist_session* session = bracket();
  CHECK(hextwist_run(session, "refine curve 5\n  refine crve 3") == HEXTWIST_FAILED);
  CHECK(hextwist_error_line() == 2 && hextwist_error_column() == 10);
  CHECK(strstr(hextwist_error_message(), "did you mean 'curve'") && !strchr(hextwist_error_message(), '\n'));
  CHECK(strstr(hextwist_error(), "^~~~"));
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const int64_t n = hextwist_n_hexes(mesh);
  CHECK(n > 488); /* the first line was done */
  CHECK(hextwist_run(session, "import mesh 'nowhere.msh'") == HEXTWIST_FAILED &&
        strstr(hextwist_error(), "nowhere.msh"));
  CHECK(hextwist_run(session, NULL) == HEXTWIST_FAILED);
  CHECK(hextwist_run(NULL, "undo") == HEXTWIST_FAILED && strstr(hextwist_error(), "null"));
  CHECK(hextwist_mesh_of(NULL) == NULL);
  CHECK(hextwist_n_nodes(NULL) == 0 && hextwist_n_hexes(NULL) == 0 && hextwist_points(NULL) == NULL);
  CHECK(hextwist_hexes(NULL) == NULL && hextwist_bit_hexes(NULL) == NULL && hextwist_node_ids(NULL) == NULL);
  CHECK(hextwist_hex_ids(NULL) == NULL && hextwist_node_owners(NULL) == NULL && hextwist_hex_volumes(NULL) == NULL);
  CHECK(hextwist_surface_quads(NULL) == NULL && hextwist_n_surface_quads(NULL) == 0);
  CHECK(hextwist_n_entities(NULL, 2) == 0 && hextwist_entity_measure(NULL, 2, 1) == 0);
  CHECK(hextwist_n_groups(NULL, HEXTWIST_BLOCK) == 0 && hextwist_group_at(NULL, HEXTWIST_BLOCK, 0).n == 0);
  CHECK(hextwist_n_fields(NULL) == 0 && hextwist_field_at(NULL, 0).values == NULL);
  double nothing = 0;
  CHECK(hextwist_quality(NULL, "shape", &nothing) == HEXTWIST_FAILED && strstr(hextwist_error(), "null"));
  hextwist_mesh_free(mesh);
  mesh = hextwist_mesh_of(session);
  CHECK(hextwist_n_hexes(mesh) == n);
  hextwist_mesh_free(mesh);
  hextwist_mesh_free(NULL);
  hextwist_free(session);
  hextwist_free(NULL);
}

typedef struct Heard {
  hextwist_session* session;
  int n_output, n_notice, n_progress, n_busy, go_on;
} Heard;
static void on_output(void* user, const char* line) {
  Heard* heard = user;
  heard->n_output += line[0] != 0;
  heard->n_busy += hextwist_run(heard->session, "undo") == HEXTWIST_FAILED && strstr(hextwist_error(), "busy") != NULL;
}
static void on_notice(void* user, const char* line) {
  ((Heard*)user)->n_notice += line[0] != 0;
}
static int on_progress(void* user, const char* stage, double fraction) {
  Heard* heard = user;
  heard->n_progress += stage[0] != 0 && fraction >= 0 && fraction <= 1;
  return heard->go_on;
}

static void callbacks_hear_and_cancel(void) {
  hextwist_session* session = bracket();
  Heard heard = {session, 0, 0, 0, 0, 1};
  const hextwist_callbacks callbacks = {&heard, on_output, on_notice, on_progress};
  CHECK(hextwist_set_callbacks(session, &callbacks) == HEXTWIST_OK);
  CHECK(hextwist_run(session, "refine curve 5") == HEXTWIST_OK);
  CHECK(heard.n_output == 1 && heard.n_progress > 3 && heard.n_busy == heard.n_output);
  hextwist_mesh* before = hextwist_mesh_of(session);
  heard.go_on = 0;
  CHECK(hextwist_run(session, "refine surface 6") == HEXTWIST_CANCELLED);
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  CHECK(hextwist_n_hexes(mesh) == hextwist_n_hexes(before) && hextwist_points(mesh) == hextwist_points(before));
  CHECK(hextwist_set_callbacks(session, NULL) == HEXTWIST_OK);
  CHECK(hextwist_run(session, "refine surface 6") == HEXTWIST_OK);
  hextwist_mesh_free(mesh);
  hextwist_mesh_free(before);
  hextwist_free(session);
}

static void ranges_give_ids(void) {
  hextwist_session* session = bracket();
  int64_t *ids = NULL, n = 0;
  CHECK(hextwist_ids(session, "volume", "all", &ids, &n) == HEXTWIST_OK && n == 1 && ids[0] == 1);
  hextwist_free_array(ids);
  CHECK(hextwist_ids(session, "node", "in curve 5", &ids, &n) == HEXTWIST_OK && n > 2);
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  int64_t n_on_curve = 0;
  for (int64_t i = 0; i < hextwist_n_nodes(mesh); ++i)
    n_on_curve += hextwist_node_owners(mesh)[2 * i] == 1 && hextwist_node_owners(mesh)[2 * i + 1] == 5;
  CHECK(n >= n_on_curve && n <= n_on_curve + 2); /* and its ends */
  hextwist_mesh_free(mesh);
  hextwist_free_array(ids);
  CHECK(hextwist_ids(session, "hex", NULL, &ids, &n) == HEXTWIST_OK && n == 488);
  hextwist_free_array(ids);
  CHECK(hextwist_ids(session, "curve", "999", &ids, &n) == HEXTWIST_FAILED && strstr(hextwist_error(), "999"));
  CHECK(hextwist_ids(session, "curve", "1; undo", &ids, &n) == HEXTWIST_FAILED);
  CHECK(hextwist_ids(session, "model", "", &ids, &n) == HEXTWIST_FAILED);
  CHECK(hextwist_ids(session, NULL, "all", &ids, &n) == HEXTWIST_FAILED);
  hextwist_free_array(NULL);
  hextwist_free(session);
}

/* What comes out of one session goes into another, on the same CAD, and is the same there. */
static void arrays_go_round(void) {
  hextwist_session* session = bracket();
  CHECK(hextwist_run(session,
                     "refine curve 5; block 1 hex all; block 2 hex 1 to 9 name 'some'; nodeset 3 surface 6;"
                     "sideset 4 surface 6 name 'inlet'") == HEXTWIST_OK);
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  hextwist_group blocks[8], node_sets[8], side_sets[8];
  hextwist_field fields[8];
  hextwist_arrays a;
  memset(&a, 0, sizeof a);
  a.n_nodes = hextwist_n_nodes(mesh), a.n_hexes = hextwist_n_hexes(mesh);
  a.points = hextwist_points(mesh), a.hexes = hextwist_hexes(mesh);
  a.node_ids = hextwist_node_ids(mesh), a.hex_ids = hextwist_hex_ids(mesh);
  a.node_owners = hextwist_node_owners(mesh), a.hex_volumes = hextwist_hex_volumes(mesh);
  a.n_curve_edges = hextwist_n_curve_edges(mesh), a.curve_edges = hextwist_curve_edges(mesh);
  a.edge_curves = hextwist_edge_curves(mesh);
  a.n_surface_quads = hextwist_n_surface_quads(mesh), a.surface_quads = hextwist_surface_quads(mesh);
  a.quad_surfaces = hextwist_quad_surfaces(mesh);
  a.n_blocks = hextwist_n_groups(mesh, HEXTWIST_BLOCK);
  for (int64_t i = 0; i < a.n_blocks; ++i) blocks[i] = hextwist_group_at(mesh, HEXTWIST_BLOCK, i);
  a.n_node_sets = hextwist_n_groups(mesh, HEXTWIST_NODE_SET);
  for (int64_t i = 0; i < a.n_node_sets; ++i) node_sets[i] = hextwist_group_at(mesh, HEXTWIST_NODE_SET, i);
  a.n_side_sets = hextwist_n_groups(mesh, HEXTWIST_SIDE_SET);
  for (int64_t i = 0; i < a.n_side_sets; ++i) side_sets[i] = hextwist_group_at(mesh, HEXTWIST_SIDE_SET, i);
  CHECK(a.n_side_sets >= 1 && side_sets[a.n_side_sets - 1].n > 0);
  double* twice = malloc((size_t)a.n_nodes * 2 * sizeof *twice);
  for (int64_t i = 0; i < 2 * a.n_nodes; ++i) twice[i] = (double)i / 3;
  double* classes = malloc((size_t)a.n_hexes * sizeof *classes);
  for (int64_t i = 0; i < a.n_hexes; ++i) classes[i] = (double)(i % 3);
  fields[0] = (hextwist_field){"twice", 0, 2, twice, 0};
  fields[1] = (hextwist_field){"class", 1, 1, classes, 1};
  a.blocks = blocks, a.node_sets = node_sets, a.side_sets = side_sets, a.fields = fields, a.n_fields = 2;

  hextwist_session* other = hextwist_create();
  char text[2048];
  snprintf(text, sizeof text, "import brep '%s/bracket.brep'", models);
  CHECK(hextwist_run(other, text) == HEXTWIST_OK);
  CHECK(hextwist_take(other, &a) == HEXTWIST_OK);
  hextwist_mesh* same = hextwist_mesh_of(other);
  CHECK(hextwist_n_nodes(same) == a.n_nodes && hextwist_n_hexes(same) == a.n_hexes);
  CHECK(memcmp(hextwist_points(same), a.points, (size_t)a.n_nodes * 3 * sizeof(double)) == 0);
  CHECK(memcmp(hextwist_hexes(same), a.hexes, (size_t)a.n_hexes * 8 * sizeof(int32_t)) == 0);
  CHECK(memcmp(hextwist_node_ids(same), a.node_ids, (size_t)a.n_nodes * sizeof(int64_t)) == 0);
  CHECK(memcmp(hextwist_node_owners(same), a.node_owners, (size_t)a.n_nodes * 2 * sizeof(int32_t)) == 0);
  CHECK(hextwist_n_surface_quads(same) == a.n_surface_quads && hextwist_n_curve_edges(same) == a.n_curve_edges);
  CHECK(memcmp(hextwist_surface_quads(same), a.surface_quads, (size_t)a.n_surface_quads * 16) == 0);
  CHECK(memcmp(hextwist_quad_surfaces(same), a.quad_surfaces, (size_t)a.n_surface_quads * 4) == 0);
  for (int64_t i = 0; i < a.n_side_sets; ++i) {
    const hextwist_group set = hextwist_group_at(same, HEXTWIST_SIDE_SET, i);
    CHECK(set.id == side_sets[i].id && set.n == side_sets[i].n && strcmp(set.name, side_sets[i].name) == 0);
    CHECK(memcmp(set.members, side_sets[i].members, (size_t)set.n * 16) == 0);
  }
  CHECK(hextwist_n_fields(same) == 2);
  CHECK(hextwist_field_at(same, 1).is_integer == 1 && hextwist_field_at(same, 0).is_integer == 0);
  const hextwist_field field = hextwist_field_at(same, 0);
  CHECK(strcmp(field.name, "twice") == 0 && !field.on_hexes && field.n_components == 2);
  CHECK(memcmp(field.values, twice, (size_t)a.n_nodes * 2 * sizeof *twice) == 0);
  CHECK(hextwist_field_at(same, 2).name == NULL && hextwist_group_at(same, HEXTWIST_BLOCK, 99).id == 0);
  CHECK(hextwist_run(other, "refine curve 5; undo; undo") == HEXTWIST_OK); /* the taking, too */

  /* What is wrong with arrays is said; the session stays as it was. */
  hextwist_arrays bad = a;
  int32_t* hexes = malloc((size_t)a.n_hexes * 32);
  memcpy(hexes, a.hexes, (size_t)a.n_hexes * 32);
  hexes[8 * 5 + 3] = (int32_t)a.n_nodes;
  bad.hexes = hexes;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "hexes[5]: there is no node"));
  bad = a, bad.points = NULL;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "points: the array is missing"));
  bad = a, bad.n_nodes = -1;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "-1"));
  bad = a, bad.n_nodes = (int64_t)1 << 40;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "2147483647"));
  const double* const parts = a.points; /* of no whole numbers */
  const hextwist_field alike[2] = {{"f", 0, 1, parts, 0}, {"f", 0, 3, parts, 0}}, fraction = {"f", 0, 3, parts, 1};
  bad = a, bad.fields = alike, bad.n_fields = 2;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "two fields of nodes are called 'f'"));
  bad = a, bad.fields = &fraction, bad.n_fields = 1;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "of whole numbers"));
  bad = a;
  int64_t* ids = malloc((size_t)a.n_nodes * sizeof *ids);
  memcpy(ids, a.node_ids, (size_t)a.n_nodes * sizeof *ids);
  ids[7] = ids[6];
  bad.node_ids = ids;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "node_ids[7]"));
  bad = a;
  const int32_t no_side[4] = {a.hexes[0], a.hexes[1], a.hexes[2], a.hexes[6]};
  const hextwist_group odd = {3, NULL, 1, no_side};
  bad.side_sets = &odd, bad.n_side_sets = 1;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "side set 3[0] is not a side"));
  const hextwist_group repeated[2] = {{3, "a", 0, NULL}, {3, "b", 0, NULL}};
  bad.side_sets = repeated, bad.n_side_sets = 2;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "occurs twice"));
  const hextwist_group nameless[1] = {{0, "a", 0, NULL}};
  bad = a, bad.blocks = nameless, bad.n_blocks = 1;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "positive"));
  const int32_t hex_outside = (int32_t)a.n_hexes;
  const hextwist_group outside = {1, "a", 1, &hex_outside};
  bad = a, bad.blocks = &outside, bad.n_blocks = 1;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "there is no hex"));
  fields[0].n_components = 0;
  CHECK(hextwist_take(session, &a) == HEXTWIST_FAILED && strstr(hextwist_error(), "no component"));
  fields[0].name = NULL;
  CHECK(hextwist_take(session, &a) == HEXTWIST_FAILED && strstr(hextwist_error(), "have names"));
  int32_t* owners = malloc((size_t)a.n_nodes * 8);
  memcpy(owners, a.node_owners, (size_t)a.n_nodes * 8);
  owners[2 * 3] = 4;
  bad = a, bad.n_fields = 0, bad.node_owners = owners;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "node_owners[3]"));
  double* points = malloc((size_t)a.n_nodes * 24);
  memcpy(points, a.points, (size_t)a.n_nodes * 24);
  points[3 * 4 + 1] = NAN;
  bad.node_owners = NULL, bad.points = points;
  CHECK(hextwist_take(session, &bad) == HEXTWIST_FAILED && strstr(hextwist_error(), "points[4]"));
  CHECK(hextwist_take(session, NULL) == HEXTWIST_FAILED);
  hextwist_mesh* kept = hextwist_mesh_of(session);
  CHECK(hextwist_points(kept) == a.points);
  hextwist_mesh_free(kept);
  free(points), free(owners), free(ids), free(hexes), free(twice);
  free(classes);
  hextwist_mesh_free(same);
  hextwist_mesh_free(mesh);
  hextwist_free(other);
  hextwist_free(session);
}

static void hexes_are_adapted(void) {
  hextwist_session* session = bracket();
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const int64_t n = hextwist_n_hexes(mesh);
  uint8_t* flags = calloc((size_t)n, 1);
  flags[17] = 1;
  int32_t* origin = NULL;
  CHECK(hextwist_adapt_flags(session, flags, n, NULL, &origin) == HEXTWIST_OK && origin);
  hextwist_mesh* adapted = hextwist_mesh_of(session);
  int64_t n_children = 0;
  for (int64_t h = 0; h < hextwist_n_hexes(adapted); ++h) n_children += origin[h] == 17;
  CHECK(n_children == 27);
  CHECK(fabs(volume(adapted) / volume(mesh) - 1) < 0.01);
  hextwist_free_array(origin);
  CHECK(hextwist_adapt_flags(session, flags, n, NULL, &origin) == HEXTWIST_FAILED && origin == NULL);
  CHECK(strstr(hextwist_error(), "flags"));
  CHECK(hextwist_adapt_flags(session, NULL, n, NULL, NULL) == HEXTWIST_FAILED);
  CHECK(hextwist_run(session, "undo") == HEXTWIST_OK);
  double* sizes = malloc((size_t)n * sizeof *sizes);
  for (int64_t h = 0; h < n; ++h) sizes[h] = h == 17 ? 1 : INFINITY;
  const hextwist_adapt_options options = {1, 1, 1, 1.5, HEXTWIST_AUTOMATIC, NULL, 0};
  CHECK(hextwist_adapt_sizes(session, sizes, n, &options, NULL) == HEXTWIST_OK);
  hextwist_mesh* sized = hextwist_mesh_of(session);
  CHECK(hextwist_n_hexes(sized) > n);
  CHECK(hextwist_run(session, "undo") == HEXTWIST_OK);
  flags[17] = 0; /* nothing to do */
  CHECK(hextwist_adapt_flags(session, flags, n, NULL, &origin) == HEXTWIST_OK && origin && origin[n - 1] == n - 1);
  hextwist_free_array(origin);
  int8_t* changes = calloc((size_t)n, 1);
  changes[17] = 1;
  int8_t* kind = NULL;
  int32_t *first = NULL, *hexes = NULL;
  CHECK(hextwist_adapt_levels(session, changes, n, NULL, &kind, &first, &hexes) == HEXTWIST_OK && kind && first &&
        hexes);
  hextwist_mesh* finer = hextwist_mesh_of(session);
  const int64_t n_finer = hextwist_n_hexes(finer);
  CHECK(first[n_finer] >= n_finer && kind[0] == 0 && hexes[first[0]] == 0);
  hextwist_free_array(kind), hextwist_free_array(first), hextwist_free_array(hexes);
  changes = realloc(changes, (size_t)n_finer);
  memset(changes, -1, (size_t)n_finer);
  CHECK(hextwist_adapt_levels(session, changes, n_finer, NULL, NULL, NULL, NULL) == HEXTWIST_OK);
  hextwist_mesh_free(finer);
  finer = hextwist_mesh_of(session);
  CHECK(hextwist_n_hexes(finer) == n);
  hextwist_mesh_free(finer);
  CHECK(hextwist_adapt_levels(session, NULL, n, NULL, &kind, NULL, NULL) == HEXTWIST_FAILED && kind == NULL);
  free(changes);
  free(sizes), free(flags);
  hextwist_mesh_free(sized);
  hextwist_mesh_free(adapted);
  hextwist_mesh_free(mesh);
  hextwist_free(session);
}

/* y = matrix * x, by rows. */
static double row(int64_t i, const int64_t* first, const int32_t* columns, const double* values, const double* x) {
  double sum = 0;
  for (int64_t k = first[i]; k < first[i + 1]; ++k) sum += values[k] * x[columns[k]];
  return sum;
}

/* Of field i, on hexes. */
static double total(const hextwist_mesh* mesh, int64_t i) {
  double sum = 0;
  const hextwist_field field = hextwist_field_at(mesh, i);
  for (int64_t h = 0; h < hextwist_n_hexes(mesh); ++h) sum += field.values[h];
  return sum;
}

static void extensive_fields_keep_their_sum(void) {
  hextwist_session* session = bracket();
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  const int64_t n = hextwist_n_hexes(mesh), at = hextwist_n_fields(mesh);
  hextwist_mesh_free(mesh);
  double* ones = malloc((size_t)n * sizeof *ones);
  for (int64_t h = 0; h < n; ++h) ones[h] = 1;
  const hextwist_field mass = {"mass", 1, 1, ones, 0}, density = {"density", 1, 1, ones, 0};
  CHECK(!hextwist_set_field(session, &mass, n) && !hextwist_set_field(session, &density, n));
  uint8_t* flags = calloc((size_t)n, 1);
  int8_t* changes = calloc((size_t)n, 1);
  flags[17] = 1, changes[17] = 1;
  const char* const names[] = {"mass", NULL};
  hextwist_adapt_options options = {0, 0, 0, 0, HEXTWIST_AUTOMATIC, names, 1};
  for (int by_levels = 0; by_levels < 2; ++by_levels) {
    CHECK((by_levels ? hextwist_adapt_levels(session, changes, n, &options, NULL, NULL, NULL)
                     : hextwist_adapt_flags(session, flags, n, &options, NULL)) == HEXTWIST_OK);
    mesh = hextwist_mesh_of(session);
    CHECK(hextwist_n_hexes(mesh) > n && fabs(total(mesh, at) / (double)n - 1) < 1e-12);
    CHECK(total(mesh, at + 1) == (double)hextwist_n_hexes(mesh));
    hextwist_mesh_free(mesh);
    CHECK(hextwist_run(session, "undo") == HEXTWIST_OK);
  }
  options.n_extensive = 2;
  CHECK(hextwist_adapt_flags(session, flags, n, &options, NULL) == HEXTWIST_FAILED && strstr(hextwist_error(), "1"));
  options.n_extensive = -1;
  CHECK(hextwist_adapt_flags(session, flags, n, &options, NULL) == HEXTWIST_FAILED);
  options.n_extensive = 1, options.extensive = NULL;
  CHECK(hextwist_adapt_flags(session, flags, n, &options, NULL) == HEXTWIST_FAILED);
  free(ones), free(flags), free(changes);
  hextwist_free(session);
}

static void fields_are_set_and_taken_along(void) {
  hextwist_session* session = bracket();
  hextwist_mesh* bare = hextwist_mesh_of(session);
  const int64_t n = hextwist_n_nodes(bare), n_hexes = hextwist_n_hexes(bare), n_fields = hextwist_n_fields(bare);
  const double* p = hextwist_points(bare);
  double* values = malloc((size_t)n * sizeof *values);
  for (int64_t i = 0; i < n; ++i) values[i] = p[3 * i] - 2 * p[3 * i + 1] + 3 * p[3 * i + 2] + 4;
  hextwist_field field = {"linear", 0, 1, values, 0};
  CHECK(hextwist_set_field(session, &field, n) == HEXTWIST_OK);
  CHECK(hextwist_n_fields(bare) == n_fields); /* stays as it was */
  hextwist_mesh* before = hextwist_mesh_of(session);
  CHECK(hextwist_n_fields(before) == n_fields + 1);
  CHECK(hextwist_set_field(session, &field, n) == HEXTWIST_OK); /* in its place */
  CHECK(hextwist_set_field(session, &field, n - 1) == HEXTWIST_FAILED && strstr(hextwist_error(), "linear"));
  field.n_components = 0;
  CHECK(hextwist_set_field(session, &field, n) == HEXTWIST_FAILED && strstr(hextwist_error(), "component"));
  field.name = NULL;
  CHECK(hextwist_set_field(session, &field, n) == HEXTWIST_FAILED);
  CHECK(hextwist_set_field(session, NULL, n) == HEXTWIST_FAILED);
  CHECK(hextwist_set_field(NULL, NULL, n) == HEXTWIST_FAILED && strstr(hextwist_error(), "null"));
  const hextwist_field level = {"level", 1, 1, values, 0};
  CHECK(hextwist_set_field(session, &level, n_hexes) == HEXTWIST_FAILED && strstr(hextwist_error(), "level"));
  const double half = 0.5;
  const hextwist_field whole = {"whole", 0, 1, &half, 1};
  CHECK(hextwist_set_field(session, &whole, INT64_MAX) == HEXTWIST_FAILED &&
        strstr(hextwist_error(), "more than a mesh can have"));

  uint8_t* flags = calloc((size_t)n_hexes, 1);
  flags[17] = flags[100] = 1;
  int32_t* origin = NULL;
  hextwist_adapt_options options;
  memset(&options, 0, sizeof options);
  options.method = 7;
  CHECK(hextwist_adapt_flags(session, flags, n_hexes, &options, &origin) == HEXTWIST_FAILED &&
        strstr(hextwist_error(), "7"));
  options.method = HEXTWIST_SINGLE;
  CHECK(hextwist_adapt_flags(session, flags, n_hexes, &options, &origin) == HEXTWIST_OK);
  hextwist_mesh* after = hextwist_mesh_of(session);
  const double* q = hextwist_points(after);
  int64_t* first = NULL;
  int32_t* columns = NULL;
  double* matrix = NULL;
  double worst = 0;
  CHECK(hextwist_prolongation(before, after, origin, &first, &columns, &matrix) == HEXTWIST_OK);
  for (int64_t i = 0; i < hextwist_n_nodes(after); ++i)
    worst = fmax(worst,
                 fabs(row(i, first, columns, matrix, values) - (q[3 * i] - 2 * q[3 * i + 1] + 3 * q[3 * i + 2] + 4)));
  CHECK(worst < 1e-10);
  hextwist_free_array(first), hextwist_free_array(columns), hextwist_free_array(matrix);
  first = NULL;
  CHECK(hextwist_prolongation(before, NULL, NULL, &first, &columns, &matrix) == HEXTWIST_FAILED && !first);
  CHECK(hextwist_prolongation(before, after, NULL, NULL, &columns, &matrix) == HEXTWIST_FAILED);
  origin[0] = -5;
  CHECK(hextwist_prolongation(before, after, origin, &first, &columns, &matrix) == HEXTWIST_FAILED && !first &&
        strstr(hextwist_error(), "origin[0]"));

  /* At points: of the mesh, and far away. */
  const double points[6] = {(p[0] + p[3]) / 2, (p[1] + p[4]) / 2, (p[2] + p[5]) / 2, 1e4, 0, 0};
  int32_t hexes[2] = {-1, -1};
  double distances[2] = {-1, -1}, at[2] = {0, 0};
  CHECK(hextwist_locate(before, points, 2, hexes, distances) == HEXTWIST_OK && hexes[0] >= 0 && hexes[1] >= 0 &&
        distances[1] > 9e3);
  CHECK(hextwist_locate(before, points, 1, NULL, NULL) == HEXTWIST_OK);
  CHECK(hextwist_field_at_points(before, n_fields, points, 2, at) == HEXTWIST_OK);
  if (distances[0] == 0) CHECK(fabs(at[0] - (points[0] - 2 * points[1] + 3 * points[2] + 4)) < 1e-10);
  CHECK(hextwist_interpolation(before, points, 2, &first, &columns, &matrix) == HEXTWIST_OK);
  CHECK(fabs(row(0, first, columns, matrix, values) - at[0]) < 1e-10 &&
        fabs(row(1, first, columns, matrix, values) - at[1]) < 1e-10);
  hextwist_free_array(first), hextwist_free_array(columns), hextwist_free_array(matrix);
  CHECK(hextwist_field_at_points(before, n_fields + 1, points, 2, at) == HEXTWIST_FAILED &&
        strstr(hextwist_error(), "field"));
  CHECK(hextwist_field_at_points(before, -1, points, 2, at) == HEXTWIST_FAILED);
  CHECK(hextwist_field_at_points(NULL, 0, points, 2, at) == HEXTWIST_FAILED);
  CHECK(hextwist_field_at_points(before, n_fields, NULL, 2, at) == HEXTWIST_FAILED);
  CHECK(hextwist_field_at_points(before, n_fields, points, 2, NULL) == HEXTWIST_FAILED);
  CHECK(hextwist_locate(before, NULL, 2, hexes, distances) == HEXTWIST_FAILED);
  CHECK(hextwist_locate(before, points, -1, hexes, distances) == HEXTWIST_FAILED);
  CHECK(hextwist_interpolation(NULL, points, 2, &first, &columns, &matrix) == HEXTWIST_FAILED);
  const double lost[3] = {0, NAN, 0};
  CHECK(hextwist_locate(before, lost, 1, hexes, distances) == HEXTWIST_FAILED && strstr(hextwist_error(), "points[0]"));
  hextwist_free_array(origin);
  free(flags), free(values);
  hextwist_mesh_free(after), hextwist_mesh_free(before), hextwist_mesh_free(bare);
  hextwist_free(session);
}

static void groups_and_surfaces_are_looked_up(void) {
  hextwist_session* session = bracket();
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  for (int64_t i = 0; i < hextwist_n_groups(mesh, HEXTWIST_SIDE_SET); ++i) {
    const hextwist_group set = hextwist_group_at(mesh, HEXTWIST_SIDE_SET, i);
    CHECK(hextwist_group_named(mesh, HEXTWIST_SIDE_SET, set.name).id == set.id);
    const int32_t* sides = hextwist_side_set_sides(mesh, i);
    for (int64_t k = 0; k < set.n; ++k) { /* the nodes of that face of the hex are those of the quad */
      const int32_t* hex = hextwist_bit_hexes(mesh) + 8 * sides[2 * k];
      int n_found = 0;
      for (int c = 0; c < 8; ++c)
        if ((c >> (sides[2 * k + 1] >> 1) & 1) == (sides[2 * k + 1] & 1))
          for (int j = 0; j < 4; ++j) n_found += set.members[4 * k + j] == hex[c];
      CHECK(n_found == 4);
    }
  }
  CHECK(hextwist_n_groups(mesh, HEXTWIST_SIDE_SET) > 0 && hextwist_side_set_sides(mesh, -1) == NULL &&
        hextwist_side_set_sides(mesh, 1000) == NULL && hextwist_side_set_sides(NULL, 0) == NULL);
  CHECK(hextwist_group_named(mesh, HEXTWIST_BLOCK, "no such").name == NULL &&
        hextwist_group_named(mesh, HEXTWIST_BLOCK, NULL).name == NULL &&
        hextwist_group_named(NULL, HEXTWIST_BLOCK, "a").name == NULL);
  const int64_t n = hextwist_n_surface_quads(mesh);
  int32_t* surfaces = malloc((size_t)n * sizeof *surfaces);
  CHECK(hextwist_surfaces_of(mesh, hextwist_surface_quads(mesh), n, surfaces) == HEXTWIST_OK);
  CHECK(memcmp(surfaces, hextwist_quad_surfaces(mesh), (size_t)n * sizeof *surfaces) == 0);
  const int32_t none[4] = {0, 0, -7, 2000000000};
  CHECK(hextwist_surfaces_of(mesh, none, 1, surfaces) == HEXTWIST_OK && surfaces[0] == 0);
  CHECK(hextwist_surfaces_of(mesh, NULL, 1, surfaces) == HEXTWIST_FAILED);
  CHECK(hextwist_surfaces_of(mesh, none, 1, NULL) == HEXTWIST_FAILED);
  CHECK(hextwist_surfaces_of(NULL, none, 1, surfaces) == HEXTWIST_FAILED);
  CHECK(hextwist_surfaces_of(mesh, NULL, 0, NULL) == HEXTWIST_OK);
  free(surfaces);
  hextwist_mesh_free(mesh);
  hextwist_free(session);
}

static void an_empty_session_has_an_empty_mesh(void) {
  hextwist_session* session = hextwist_create();
  hextwist_mesh* mesh = hextwist_mesh_of(session);
  CHECK(mesh && hextwist_n_hexes(mesh) == 0 && hextwist_n_nodes(mesh) == 0 && hextwist_n_entities(mesh, 2) == 0);
  CHECK(hextwist_n_surface_quads(mesh) == 0 && hextwist_n_curve_edges(mesh) == 0 && hextwist_points(mesh) == NULL);
  CHECK(hextwist_n_groups(mesh, HEXTWIST_NODE_SET) == 0 && hextwist_n_fields(mesh) == 0);
  const uint8_t none = 0;
  CHECK(hextwist_adapt_flags(session, &none, 0, NULL, NULL) == HEXTWIST_FAILED && strstr(hextwist_error(), "no mesh"));
  hextwist_mesh_free(mesh);
  hextwist_free(session);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  models = argv[1];
  CHECK(strlen(hextwist_version()) >= 5);
  CHECK(strcmp(hextwist_error(), "") == 0);
  arrays_describe_the_mesh();
  a_mesh_outlives_commands_and_its_session();
  errors_say_what_is_wrong_and_where();
  callbacks_hear_and_cancel();
  ranges_give_ids();
  arrays_go_round();
  hexes_are_adapted();
  extensive_fields_keep_their_sum();
  fields_are_set_and_taken_along();
  groups_and_surfaces_are_looked_up();
  an_empty_session_has_an_empty_mesh();
  if (n_failed) fprintf(stderr, "%d checks failed\n", n_failed);
  return n_failed != 0;
}
