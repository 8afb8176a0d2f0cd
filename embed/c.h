/* hextwist for C, and for every language that can call C.
 *
 *   hextwist_session* session = hextwist_create();
 *   if (hextwist_run(session, "import step 'part.step'; import mesh 'part.msh'; refine curve 3 numsplit 2"))
 *     fprintf(stderr, "%s\n", hextwist_error());
 *   hextwist_mesh* mesh = hextwist_mesh_of(session);
 *   const double* points = hextwist_points(mesh);
 *   ...
 *   hextwist_mesh_free(mesh);
 *   hextwist_free(session);
 *
 * Guarantees:
 *  1. a call that fails leaves the session as it was; no C++ exception gets out of any call;
 *  2. a hextwist_mesh is what the session's mesh was when it was asked for, until it is freed: whatever the session
 * does meanwhile, also when it is freed. Every pointer from it is valid as long, and is not to be written through or
 * freed;
 *  3. results are the same for any number of threads.
 *
 * Numbers: positions in arrays are int32_t and count from 0 (-1: none), so a mesh has at most 2^31 - 1 nodes and as
 * many hexes; ids as users know them are int64_t and positive; counts are int64_t. That is part of the ABI: larger
 * meshes would need functions of other names. The shared library's version is that of the ABI; before 1.0 it may change
 * with each minor version. Structs are passed by pointer; set them to zero first, since later versions may add members
 * for which zero means what there is today.
 *
 * Lengths are those of the CAD (STEP and IGES: millimetres), angles degrees. Strings are UTF-8, ended by 0.
 *
 * Corners of a hex: the order of VTK, Exodus, Abaqus and Gmsh, bottom 0 1 2 3 and top 4 5 6 7, both counter-clockwise
 * seen from the top; hextwist_bit_hexes() gives the library's own order. Quads are cycles, counter-clockwise seen from
 * outside of the hex that they are a side of.
 *
 * Threads: one session is for one thread at a time, a call meanwhile (from a callback, too) fails; several sessions may
 * run side by side. A hextwist_mesh may be read by any number of threads. A call uses as many threads as `set threads`
 * says (all cores, by default), for all sessions of a process.
 */
#ifndef HEXTWIST_EMBED_C_H
#define HEXTWIST_EMBED_C_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

typedef struct hextwist_session hextwist_session;
typedef struct hextwist_mesh hextwist_mesh;

typedef enum hextwist_status {
  HEXTWIST_OK = 0,
  HEXTWIST_FAILED = 1,   /* hextwist_error() says why */
  HEXTWIST_CANCELLED = 2 /* by the progress callback */
} hextwist_status;

/* "0.1.0" */
const char* hextwist_version(void);

/* ---- sessions ---- */

/* NULL when there is no memory. */
hextwist_session* hextwist_create(void);
void hextwist_free(hextwist_session* session); /* NULL is allowed */

/* Runs commands (docs/commands.md), one per line or separated by ';', up to the first that fails. */
hextwist_status hextwist_run(hextwist_session* session, const char* commands);

/* Why the last call of this thread that failed did, "" if none has. A wrong word in a command comes with its line and a
 * caret under it, on three lines. Valid until the next call of the thread that fails. */
const char* hextwist_error(void);
/* The same on one line, without the place; the place of the wrong word in the commands, from 1, 0: no place. */
const char* hextwist_error_message(void);
int hextwist_error_line(void);
int hextwist_error_column(void);

/* Called on the thread that runs the command. Any may be NULL. Strings are valid during the call. */
typedef struct hextwist_callbacks {
  void* user;                                                      /* handed to each */
  void (*output)(void* user, const char* line);                    /* what a command prints */
  void (*notice)(void* user, const char* line);                    /* remarks: what was repaired, glued, skipped */
  int (*progress)(void* user, const char* stage, double fraction); /* 0..1; return 0 to cancel */
} hextwist_callbacks;
/* NULL: none. */
hextwist_status hextwist_set_callbacks(hextwist_session* session, const hextwist_callbacks* callbacks);

/* Ids of the entities of a kind that a range means: hextwist_ids(s, "node", "in curve 3", &ids, &n). ascending. The
 * array is the caller's: hextwist_free_array(). */
hextwist_status hextwist_ids(hextwist_session* session, const char* kind, const char* range, int64_t** ids, int64_t* n);
void hextwist_free_array(void* array); /* NULL is allowed */

/* ---- the mesh as arrays ---- */

/* The mesh of the session as it is now; without hexes where the session has none. Costs nothing: arrays are those of
 * the session, which copies when it changes them. NULL when there is no memory or the session is busy;
 * the functions below take that for a mesh without nodes. */
hextwist_mesh* hextwist_mesh_of(hextwist_session* session);
void hextwist_mesh_free(hextwist_mesh* mesh); /* NULL is allowed */

int64_t hextwist_n_nodes(const hextwist_mesh* mesh);
int64_t hextwist_n_hexes(const hextwist_mesh* mesh);
const double* hextwist_points(const hextwist_mesh* mesh); /* 3 per node: x y z */
const int32_t* hextwist_hexes(const hextwist_mesh* mesh); /* 8 per hex: nodes; made when first asked for */
const int32_t* hextwist_bit_hexes(
    const hextwist_mesh* mesh);                              /* the same, corner c at (c & 1, c >> 1 & 1, c >> 2 & 1) */
const int64_t* hextwist_node_ids(const hextwist_mesh* mesh); /* 1 per node, ascending */
const int64_t* hextwist_hex_ids(const hextwist_mesh* mesh);  /* 1 per hex, ascending */

/* Who owns what: dimension (0 vertex, 1 curve, 2 surface, 3 volume; -1 nobody) and id, from 1. Of the CAD, or of the
 * skin of the mesh where there is none. */
const int32_t* hextwist_node_owners(const hextwist_mesh* mesh);    /* 2 per node: dimension, id */
const double* hextwist_node_parameters(const hextwist_mesh* mesh); /* 2 per node: u v on a surface, t and NaN on a
                                                                      curve, else NaN */
const int32_t* hextwist_hex_volumes(const hextwist_mesh* mesh);    /* 1 per hex: id of its volume */
int64_t hextwist_n_curve_edges(const hextwist_mesh* mesh);         /* edges of the mesh that lie on curves */
const int32_t* hextwist_curve_edges(const hextwist_mesh* mesh);    /* 2 per edge: nodes, the lower first */
const int32_t* hextwist_edge_curves(const hextwist_mesh* mesh);    /* 1 per edge: id of its curve */
int64_t hextwist_n_surface_quads(const hextwist_mesh* mesh);       /* sides on surfaces, each once */
const int32_t* hextwist_surface_quads(const hextwist_mesh* mesh);  /* 4 per quad: nodes; made when first asked for */
const int32_t* hextwist_surface_sides(const hextwist_mesh* mesh);  /* 2 per quad: hex, and face 2 * axis + side in the
                                                                      library's own order of corners */
const int32_t* hextwist_quad_surfaces(const hextwist_mesh* mesh);  /* 1 per quad: id of its surface */

/* How many entities of a dimension the CAD (or skin) has; length, area or volume of one, 0 for a vertex and for what
 * does not exist. */
int64_t hextwist_n_entities(const hextwist_mesh* mesh, int dim);
double hextwist_entity_measure(const hextwist_mesh* mesh, int dim, int id);

/* Blocks (members: hexes, 1 each), node sets (nodes, 1 each), side sets (4 nodes each: quads). */
typedef enum hextwist_group_kind {
  HEXTWIST_BLOCK = 0,
  HEXTWIST_NODE_SET = 1,
  HEXTWIST_SIDE_SET = 2
} hextwist_group_kind;
typedef struct hextwist_group {
  int32_t id;             /* positive, each once per kind */
  const char* name;       /* "" or NULL: none */
  int64_t n;              /* members */
  const int32_t* members; /* ascending, but for side sets */
} hextwist_group;
int64_t hextwist_n_groups(const hextwist_mesh* mesh, hextwist_group_kind kind);
/* Group i from 0; all zero when there is none. */
hextwist_group hextwist_group_at(const hextwist_mesh* mesh, hextwist_group_kind kind, int64_t i);

typedef struct hextwist_field {
  const char* name;
  int32_t on_hexes;     /* 0: on nodes */
  int32_t n_components; /* 1 scalar, 3 vector, ... */
  const double* values; /* n_components per node or hex */
  int32_t is_integer;   /* classes, flags, numbers of things: never interpolated */
} hextwist_field;
int64_t hextwist_n_fields(const hextwist_mesh* mesh);
hextwist_field hextwist_field_at(const hextwist_mesh* mesh, int64_t i);

/* One value per hex of a metric by its usual name ("shape", "scaled jacobian", ...), into `values`. */
hextwist_status hextwist_quality(const hextwist_mesh* mesh, const char* metric, double* values);

/* ---- a mesh from arrays ---- */

typedef struct hextwist_arrays {
  int64_t n_nodes, n_hexes;
  const double* points;    /* 3 per node */
  const int32_t* hexes;    /* 8 per hex */
  const int64_t* node_ids; /* ascending; NULL: 1, 2, ... */
  const int64_t* hex_ids;  /* ascending; NULL: 1, 2, ... */
  /* What is known about owners, NULL or 0 where nothing is. It is checked against the CAD, which has the last word. */
  const int32_t* node_owners; /* 2 per node: dimension, id; -1 0: unknown */
  const int32_t* hex_volumes; /* 1 per hex, 0: unknown */
  int64_t n_curve_edges;
  const int32_t* curve_edges; /* 2 per edge */
  const int32_t* edge_curves;
  int64_t n_surface_quads;
  const int32_t* surface_quads; /* 4 per quad, a cycle that may start anywhere and turn either way */
  const int32_t* quad_surfaces;
  int64_t n_blocks, n_node_sets, n_side_sets, n_fields;
  const hextwist_group* blocks;
  const hextwist_group* node_sets;
  const hextwist_group* side_sets; /* of a quad between two hexes the side from which its cycle turns outwards */
  const hextwist_field* fields;
} hextwist_arrays;

/* Makes a copy of these arrays the mesh of the session, as `import mesh` does with a file: checked, untangled if need
 * be, and associated with the CAD that the session has (`import step ...` before it), or with the skin of the mesh. */
hextwist_status hextwist_take(hextwist_session* session, const hextwist_arrays* arrays);

/* ---- adaptive analysis ---- */

typedef struct hextwist_adapt_options {
  int32_t no_gradation; /* 0: by levels: pieces of a transition are never cut again, so shapes stay as good as they are
                           after the first call, and what was cut can become coarser. 1: exactly the flagged hexes */
  int32_t fill_concave; /* 0: templates of their own where a region is concave */
  int32_t smooth;
  double bias; /* of sizes: growth from element to element, 1 or 0: not limited */
} hextwist_adapt_options;

/* Cuts the hexes with flags[h] != 0 into 27 each, or all hexes until they have their sizes (model units, infinity: no
 * wish). One value per hex of the session's mesh. options may be NULL. If origin is not NULL, *origin is set to one hex
 * of the old mesh per hex of the new one, in which it lies; it is the caller's: hextwist_free_array(). */
hextwist_status hextwist_adapt_flags(hextwist_session* session, const uint8_t* flags, int64_t n,
                                     const hextwist_adapt_options* options, int32_t** origin);
/* By how many levels each hex becomes finer (> 0) or coarser (< 0); 27 become one again where none of them stays. Hexes
 * h of the new mesh lie in, or were made of, the old hexes[first[h]] .. hexes[first[h + 1] - 1]; kind[h] is 0: the same
 * hex, 1: it lies in a larger one that is gone, 2: the cell that it is, or is a piece of, was several hexes. Each of
 * the three may be NULL; they are the caller's: hextwist_free_array(). Fields of hexes are copied down and averaged by
 * volume upwards, those of nodes interpolated and injected. */
hextwist_status hextwist_adapt_levels(hextwist_session* session, const int8_t* changes, int64_t n,
                                      const hextwist_adapt_options* options, int8_t** kind, int32_t** first,
                                      int32_t** hexes);
hextwist_status hextwist_adapt_sizes(hextwist_session* session, const double* sizes, int64_t n,
                                     const hextwist_adapt_options* options, int32_t** origin);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
