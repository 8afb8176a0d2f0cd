/** hextwist for C, and for every language that can call C.
 *
 *     hextwist_session* session = hextwist_create();
 *     if (hextwist_run(session, "import step 'part.step'; import mesh 'part.msh'; refine curve 3 numsplit 2"))
 *       fprintf(stderr, "%s\n", hextwist_error());
 *     hextwist_mesh* mesh = hextwist_mesh_of(session);
 *     const double* points = hextwist_points(mesh);
 *     ...
 *     hextwist_mesh_free(mesh);
 *     hextwist_free(session);
 *
 * Guarantees:
 *  1. a call that fails leaves the session as it was; no C++ exception gets out of any call;
 *  2. a hextwist_mesh is what the session's mesh was when it was asked for, until it is freed: whatever the
 *     session does meanwhile, also when it is freed. Every pointer from it is valid as long, and is not to be
 *     written through or freed;
 *  3. results are the same for any number of threads.
 *
 * Numbers: positions in arrays are int32_t and count from 0 (-1: none), so a mesh has at most 2^31 - 1 nodes and as
 * many hexes; ids as users know them are positive, int64_t, of groups and entities of the CAD int32_t; counts are
 * int64_t. That is part of the ABI: larger meshes would need functions of other names. The shared library's version is
 * that of the ABI; before 1.0 it may change with each minor version. Structs that you fill are passed by pointer, read
 * during the call and copied; set them to zero first, since later versions may add members for which zero means what
 * there is today.
 *
 * Memory: what a call gives to you (ids, origins) is yours until hextwist_free_array(); sessions and meshes go by
 * functions of their own; all else belongs to the mesh or the library. An array of no items is NULL, but those that are
 * given to you. NULL in place of a session fails, in place of a mesh is a mesh without nodes.
 *
 * Lengths are those of the CAD (STEP and IGES: millimetres), angles degrees. Strings are ended by 0, and UTF-8 but for
 * what comes from files: names of groups and fields are the bytes of the file.
 *
 * Corners of a hex: the order of VTK, Exodus, Abaqus and Gmsh, bottom 0 1 2 3 and top 4 5 6 7, both counter-clockwise
 * seen from the top; hextwist_bit_hexes() gives the library's own order. Quads are cycles, counter-clockwise seen from
 * outside of the hex that they are a side of.
 *
 * Threads: one session is for one thread at a time, a call meanwhile (from a callback, too) fails; several sessions may
 * run side by side. A hextwist_mesh may be read by any number of threads. A call uses as many threads as `set threads`
 * says (all cores, by default), for all sessions of a process.
 *
 * @file
 * @ingroup embed
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

/** A mesh on its model, changed by commands: from hextwist_create() to hextwist_free(). */
typedef struct hextwist_session hextwist_session;
/** The mesh of a session at one moment: from hextwist_mesh_of() to hextwist_mesh_free(). */
typedef struct hextwist_mesh hextwist_mesh;

/** What calls that can fail return; 0 is success. */
typedef enum hextwist_status {
  HEXTWIST_OK = 0,       /**< done */
  HEXTWIST_FAILED = 1,   /**< hextwist_error() says why */
  HEXTWIST_CANCELLED = 2 /**< by the progress callback */
} hextwist_status;

/** Of the library that is linked: "0.1.0". Valid for ever. */
const char* hextwist_version(void);

/* ---- sessions ---- */

/** An empty session, without CAD and mesh. NULL when there is no memory. */
hextwist_session* hextwist_create(void);
/** Meshes of the session stay. NULL is allowed. Not while a call of the session runs, from its callbacks neither. */
void hextwist_free(hextwist_session* session);

/** Runs commands (docs/commands.md), one per line or separated by ';', up to the first that fails or is cancelled: that
 * one changes nothing, those before it stay done. Prints nothing: what commands say goes to callbacks. */
hextwist_status hextwist_run(hextwist_session* session, const char* commands);

/** Why the last call of this thread that failed (or was cancelled) did, "" if none has; never NULL. A call that
 * succeeds leaves it alone, so look at the status first. A wrong word in a command comes with its line and a caret
 * under it, on three lines. Valid until the next call of the thread that fails; copy it to keep it. */
const char* hextwist_error(void);
/** The same on one line, without the place. */
const char* hextwist_error_message(void);
/** Line of the wrong word in the commands, from 1; 0: there is none to blame. */
int hextwist_error_line(void);
/** Character in that line, from 1; 0: there is no word to blame. */
int hextwist_error_column(void);

/** Called on the thread that runs the command. Any may be NULL: nobody is told. Strings are one line each, without a
 * line end, and valid during the call. A callback must return: no longjmp() out of it. */
typedef struct hextwist_callbacks {
  void* user;                                                      /**< yours, handed to each; may be NULL */
  void (*output)(void* user, const char* line);                    /**< what a command prints */
  void (*notice)(void* user, const char* line);                    /**< remarks: what was repaired, glued, skipped */
  int (*progress)(void* user, const char* stage, double fraction); /**< 0..1; return 0 to cancel, else to go on */
} hextwist_callbacks;
/** From now on these, instead of those before; NULL: none. The struct is copied; what `user` points to has to live
 * until other callbacks are set or the session is freed. */
hextwist_status hextwist_set_callbacks(hextwist_session* session, const hextwist_callbacks* callbacks);

/** Ids of the entities of a kind ("node", "hex", "curve", "block", ... as in commands) that a range means, ascending:
 * hextwist_ids(s, "node", "in curve 3", &ids, &n). A range of NULL is "all". *n: how many; *ids: yours, by
 * hextwist_free_array(), not NULL even when there are none. Neither is touched by a call that fails. */
hextwist_status hextwist_ids(hextwist_session* session, const char* kind, const char* range, int64_t** ids, int64_t* n);
/** For arrays that were given to you. NULL is allowed. */
void hextwist_free_array(void* array);

/* ---- the mesh as arrays ---- */

/* Arrays are NULL where there are no items, and those that are made when first asked for where there is no memory. */

/** The mesh of the session as it is now; without hexes where the session has none. Costs nothing: arrays are those of
 * the session, which copies when it changes them. Yours, by hextwist_mesh_free(). NULL when there is no memory or the
 * session is NULL or busy, and hextwist_error() says which; the functions below take that for a mesh without nodes. */
hextwist_mesh* hextwist_mesh_of(hextwist_session* session);
/** With all pointers that came from it. NULL is allowed. */
void hextwist_mesh_free(hextwist_mesh* mesh);

/** Number of nodes, those of no hex too. */
int64_t hextwist_n_nodes(const hextwist_mesh* mesh);
/** Number of hexes; 0: the session had no mesh. */
int64_t hextwist_n_hexes(const hextwist_mesh* mesh);
/** 3 per node: x y z, model units. */
const double* hextwist_points(const hextwist_mesh* mesh);
/** 8 per hex: nodes, in the order of VTK. Made when first asked for. */
const int32_t* hextwist_hexes(const hextwist_mesh* mesh);
/** 8 per hex: nodes, corner c at (c & 1, c >> 1 & 1, c >> 2 & 1) of the unit cube. */
const int32_t* hextwist_bit_hexes(const hextwist_mesh* mesh);
/** 1 per node, ascending: ids as commands know them. Where they are 1, 2, ... made when first asked for. */
const int64_t* hextwist_node_ids(const hextwist_mesh* mesh);
/** 1 per hex, ascending: ids as commands know them. Where they are 1, 2, ... made when first asked for. */
const int64_t* hextwist_hex_ids(const hextwist_mesh* mesh);

/* Who owns what: dimension (0 vertex, 1 curve, 2 surface, 3 volume; -1 nobody) and id, from 1. Of the CAD, or of the
 * skin of the mesh where there is none. */

/** 2 per node: dimension and id of the entity that it lies on; -1 and 0 of a node of no hex. */
const int32_t* hextwist_node_owners(const hextwist_mesh* mesh);
/** 2 per node: u v on a surface, t and NaN on a curve, else NaN. */
const double* hextwist_node_parameters(const hextwist_mesh* mesh);
/** 1 per hex: id of its volume. */
const int32_t* hextwist_hex_volumes(const hextwist_mesh* mesh);
/** Edges of the mesh that lie on curves, each once. */
int64_t hextwist_n_curve_edges(const hextwist_mesh* mesh);
/** 2 per such edge: nodes, the lower first. */
const int32_t* hextwist_curve_edges(const hextwist_mesh* mesh);
/** 1 per such edge: id of its curve. */
const int32_t* hextwist_edge_curves(const hextwist_mesh* mesh);
/** Sides of hexes that lie on surfaces, each once; between two volumes as a side of the hex that comes first. */
int64_t hextwist_n_surface_quads(const hextwist_mesh* mesh);
/** 4 per such side: nodes. Made when first asked for. */
const int32_t* hextwist_surface_quads(const hextwist_mesh* mesh);
/** 2 per such side: hex, and face 2 * axis + side in the order of hextwist_bit_hexes(). */
const int32_t* hextwist_surface_sides(const hextwist_mesh* mesh);
/** 1 per such side: id of its surface. */
const int32_t* hextwist_quad_surfaces(const hextwist_mesh* mesh);

/** How many entities of a dimension (0 to 3) the CAD (or skin) has; their ids are 1 to n. 0 for another dimension. */
int64_t hextwist_n_entities(const hextwist_mesh* mesh, int dim);
/** Length, area or volume of one, model units; 0 for a vertex and for what does not exist. */
double hextwist_entity_measure(const hextwist_mesh* mesh, int dim, int id);

/** What a group is of. */
typedef enum hextwist_group_kind {
  HEXTWIST_BLOCK = 0,    /**< hexes: 1 position each */
  HEXTWIST_NODE_SET = 1, /**< nodes: 1 position each */
  HEXTWIST_SIDE_SET = 2  /**< sides of hexes: 4 nodes each, a quad */
} hextwist_group_kind;
/** A block, node set or side set. Groups of a kind may overlap, and nothing need belong to any. */
typedef struct hextwist_group {
  int32_t id;             /**< each once per kind; positive in what you fill, 0 too in what comes from Exodus files */
  const char* name;       /**< "": none, in what you fill NULL too */
  int64_t n;              /**< members */
  const int32_t* members; /**< n positions, or 4 n nodes of a side set; ascending, but for side sets */
} hextwist_group;
/** How many groups of a kind there are; 0 for an unknown kind. */
int64_t hextwist_n_groups(const hextwist_mesh* mesh, hextwist_group_kind kind);
/** Group i from 0, ascending by id; its pointers belong to the mesh. All zero, name NULL too, when there is none. */
hextwist_group hextwist_group_at(const hextwist_mesh* mesh, hextwist_group_kind kind, int64_t i);

/** Values per node or per hex. */
typedef struct hextwist_field {
  const char* name;     /**< neither NULL nor "" in what you fill */
  int32_t on_hexes;     /**< 0: on nodes, else on hexes */
  int32_t n_components; /**< 1 scalar, 3 vector, ...; at least 1 */
  const double* values; /**< n_components per node or hex, one item after the other */
  int32_t is_integer;   /**< not 0: classes, flags, numbers of things: never interpolated */
} hextwist_field;
/** How many fields there are, on nodes and on hexes together. */
int64_t hextwist_n_fields(const hextwist_mesh* mesh);
/** Field i from 0; its pointers belong to the mesh. All zero, name NULL too, when there is none. */
hextwist_field hextwist_field_at(const hextwist_mesh* mesh, int64_t i);

/** The first group of a kind with that name, its pointers as above; all zero, name NULL too, when there is none, or the
 * name is NULL. Names need not be unique. */
hextwist_group hextwist_group_named(const hextwist_mesh* mesh, hextwist_group_kind kind, const char* name);
/** Side set i from 0 as 2 numbers per side, in the order of its members: hex, and face 2 * axis + side in the order of
 * hextwist_bit_hexes(). NULL when there is none. */
const int32_t* hextwist_side_set_sides(const hextwist_mesh* mesh, int64_t i);
/** Ids of the surfaces that n quads lie on, 0: on none; 4 nodes per quad, in any order. Into `surfaces`: yours, room
 * for n, not touched by a call that fails. */
hextwist_status hextwist_surfaces_of(const hextwist_mesh* mesh, const int32_t* quads, int64_t n, int32_t* surfaces);

/** One value per hex of a metric by its usual name ("shape", "scaled jacobian", ...; docs/commands.md), into `values`:
 * yours, room for hextwist_n_hexes(), not touched by a call that fails. Fails for an unknown metric and for NULL. */
hextwist_status hextwist_quality(const hextwist_mesh* mesh, const char* metric, double* values);

/* ---- values anywhere, and from mesh to mesh ---- */

/** Where n points (3 numbers each, finite) are: the hex that holds each, of several the first, and 0; outside of the
 * mesh the nearest hex and how far it is. Into arrays of yours, room for n, not touched by a call that fails; either
 * may be NULL. */
hextwist_status hextwist_locate(const hextwist_mesh* mesh, const double* points, int64_t n, int32_t* hexes,
                                double* distances);
/** Field i from 0 at n points: n_components values each, into `values`, yours, not touched by a call that fails. Nodal
 * fields are trilinear in the hex, those of hexes are that of the hex, whole numbers that of the nearest node; outside
 * of the mesh the nearest place counts. */
hextwist_status hextwist_field_at_points(const hextwist_mesh* mesh, int64_t i, const double* points, int64_t n,
                                         double* values);
/** The matrix that takes values at the nodes of a mesh to n points, as hextwist_field_at_points() does, by rows: row i
 * has values[k] in column columns[k], a node, for k from first[i] to first[i + 1] - 1, columns ascending. The three are
 * yours, by hextwist_free_array(); not touched by a call that fails. */
hextwist_status hextwist_interpolation(const hextwist_mesh* mesh, const double* points, int64_t n, int64_t** first,
                                       int32_t** columns, double** values);
/** The same to the nodes of a mesh that it was refined or coarsened to: new values = matrix * old values, exact for
 * what is linear, on a curved boundary too. origin: per hex of `after` a hex of `before` that it comes from, as
 * hextwist_adapt_flags() gives it, which keeps apart what is apart (cracks); NULL: by place alone. */
hextwist_status hextwist_prolongation(const hextwist_mesh* before, const hextwist_mesh* after, const int32_t* origin,
                                      int64_t** first, int32_t** columns, double** values);

/* ---- a mesh from arrays ---- */

/** A mesh as you have it. Arrays are yours, read during hextwist_take() alone; an array may be NULL where its count is
 * 0, and where it says so. What is known about owners (node_owners to quad_surfaces) may be partial or missing: it is
 * checked against the CAD, which has the last word. */
typedef struct hextwist_arrays {
  int64_t n_nodes;                 /**< rows of points */
  int64_t n_hexes;                 /**< rows of hexes */
  const double* points;            /**< 3 per node: x y z, finite, in the units of the CAD */
  const int32_t* hexes;            /**< 8 per hex: nodes, in the order of VTK */
  const int64_t* node_ids;         /**< positive, ascending; NULL: 1, 2, ... */
  const int64_t* hex_ids;          /**< positive, ascending; NULL: 1, 2, ... */
  const int32_t* node_owners;      /**< 2 per node: dimension, id; -1 0: unknown; NULL: all unknown */
  const int32_t* hex_volumes;      /**< 1 per hex: id of its volume, 0: unknown; NULL: all unknown */
  int64_t n_curve_edges;           /**< 0: nothing is known of edges */
  const int32_t* curve_edges;      /**< 2 per edge: nodes, in any order */
  const int32_t* edge_curves;      /**< 1 per edge: id of its curve */
  int64_t n_surface_quads;         /**< 0: nothing is known of sides */
  const int32_t* surface_quads;    /**< 4 per quad, a cycle that may start anywhere and turn either way */
  const int32_t* quad_surfaces;    /**< 1 per quad: id of its surface */
  int64_t n_blocks;                /**< items of blocks */
  int64_t n_node_sets;             /**< items of node_sets */
  int64_t n_side_sets;             /**< items of side_sets */
  int64_t n_fields;                /**< items of fields */
  const hextwist_group* blocks;    /**< members in any order, here and below */
  const hextwist_group* node_sets; /**< of nodes */
  const hextwist_group* side_sets; /**< of a quad between two hexes the side from which its cycle turns outwards */
  const hextwist_field* fields;    /**< on nodes and on hexes */
} hextwist_arrays;

/** Makes a copy of these arrays the mesh of the session, as `import mesh` does with a file: checked, untangled if need
 * be, and associated with the CAD that the session has (`import step ...` before it), or with the skin of the mesh.
 * Fails, naming array and position, for what is no mesh, and where it does not lie on the CAD. */
hextwist_status hextwist_take(hextwist_session* session, const hextwist_arrays* arrays);

/** Gives the mesh of the session this field, n values in all, in place of the one of the same name and place that it
 * has. Meshes that were handed out stay as they are. Can be undone by `undo`. */
hextwist_status hextwist_set_field(hextwist_session* session, const hextwist_field* field, int64_t n);

/* ---- adaptive analysis ---- */

/** By which technique flagged hexes are cut. */
typedef enum hextwist_method {
  HEXTWIST_AUTOMATIC = 0, /**< single */
  HEXTWIST_SINGLE = 1,    /**< one into 27 */
  HEXTWIST_PARALLEL = 2   /**< one into 8, where the sheets of the mesh allow it */
} hextwist_method;

/** How a mesh is adapted; all zero, or NULL in place of it, is the usual. */
typedef struct hextwist_adapt_options {
  /** 0: by levels: pieces of a transition are never cut again, so shapes stay as good as they are after the first call,
   * and what was cut can become coarser. 1: exactly the flagged hexes are cut. */
  int32_t no_gradation;
  int32_t fill_concave; /**< 0: templates of their own where a region is concave; 1: hexes join it until it is convex */
  int32_t smooth;       /**< 1: smooth the new hexes and two layers around them */
  double bias;          /**< of sizes: growth from element to element, above 1; 1 or 0: not limited */
  int32_t method;       /**< of hextwist_adapt_flags(): a hextwist_method */
  /** Names of fields of hexes whose sum stays, as of a mass: shared out by volume, and summed up where hexes become
   * coarser. Others are copied and averaged. NULL: none has. */
  const char* const* extensive;
  int64_t n_extensive; /**< so many of these */
} hextwist_adapt_options;

/** Cuts the hexes with flags[h] != 0 into 27 each. n: the number of hexes of the session's mesh. If origin is not NULL,
 * *origin is set to one hex of the old mesh per hex of the new one (hextwist_n_hexes() of hextwist_mesh_of() now), in
 * which it lies, or the first of those that its cell was before; it is yours, by hextwist_free_array(), and NULL after
 * a call that fails. */
hextwist_status hextwist_adapt_flags(hextwist_session* session, const uint8_t* flags, int64_t n,
                                     const hextwist_adapt_options* options, int32_t** origin);
/** By how many levels each hex becomes finer (> 0) or coarser (< 0); 27 become one again where none of them stays. Hex
 * h of the N of the new mesh lies in, or was made of, the old hexes[first[h]] .. hexes[first[h + 1] - 1]; kind[h] is 0:
 * the same hex (whose nodes may have been moved for better shapes), 1: it lies in a larger one that is gone, 2: the
 * cell that it is, or is a piece of, was several hexes. So kind has N items, first N + 1, hexes first[N]. Each of the
 * three may be NULL; they are yours, by hextwist_free_array(), and NULL after a call that fails. Fields of hexes are
 * copied down and averaged by volume upwards, but for those in options->extensive, those of nodes interpolated and
 * injected. */
hextwist_status hextwist_adapt_levels(hextwist_session* session, const int8_t* changes, int64_t n,
                                      const hextwist_adapt_options* options, int8_t** kind, int32_t** first,
                                      int32_t** hexes);
/** Cuts all hexes until they have their sizes, and by levels makes those coarser that are finer than wished. sizes: one
 * per hex, positive, model units; infinity: no wish. n and origin as for hextwist_adapt_flags(). */
hextwist_status hextwist_adapt_sizes(hextwist_session* session, const double* sizes, int64_t n,
                                     const hextwist_adapt_options* options, int32_t** origin);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
