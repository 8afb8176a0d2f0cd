// The table of all commands. Adding one means adding a row here and a function in the session.

#include "hextwist/command/syntax.h"
#include "hextwist/refine/templates/uniform.h"

namespace hextwist {
namespace {

using Kind = ArgumentSpec::Kind;

constexpr double max_group_id = 2147483647;
constexpr std::string_view range_help = "ids: 1 3, 3 to 17 by 2, all, except ..., in ..., with ...; see 'help range'";

// clang-format off
#define METRICS \
  "shape|scaled [jacobian]|=scaled_jacobian|mean [ratio]|=mean_ratio|condition [number|=no.]|=condition_number|skew" \
  "|stretch|taper|aspect [ratio]|=aspect_ratio|edge [ratio]|=edge_ratio|diagonal [=ratio]|relative [size]|=relative_size|shear" \
  "|oddy|distortion|volume|=element volume|jacobian|dimension"

#define SCHEMES \
  "scheme {mean [ratio]|=mean_ratio|condition [number]|=condition_number|laplacian|untangle|=equipotential" \
  "|=optimize [jacobian]|=winslow}"
#define ALONG "x <dx> [y <dy>] [z <dz>]|y <dy> [x <dx>] [z <dz>]|z <dz> [x <dx>] [y <dy>]"
#define WHERE_TO "{<dx> <dy> <dz>|" ALONG "}"
#define MOVES \
  "move " WHERE_TO "|scale {<factor>|x <fx> y <fy> z <fz>} [about <x> <y> <z>]" \
  "|rotate [=angle] <degrees> about {x|y|z|<ax> <ay> <az>|origin <x> <y> <z> direction <ax> <ay> <az>} [=include_merged]" \
  "|reflect {x|y|z|<ax> <ay> <az>} [=include_merged]"
#define MOVE_ARGUMENTS \
  {"dx", Kind::number, -1e100, 1e100, false, "how far along x, y and z"}, {"dy", Kind::number, -1e100, 1e100, false, ""}, \
      {"dz", Kind::number, -1e100, 1e100, false, ""}, \
      {"factor", Kind::number, 0, 1e100, true, "for all lengths"}, {"fx", Kind::number, 0, 1e100, true, "the same for x, y and z"}, \
      {"fy", Kind::number, 0, 1e100, true, ""}, {"fz", Kind::number, 0, 1e100, true, ""}, \
      {"degrees", Kind::number, -1e6, 1e6, false, "angle, counter-clockwise seen from where the axis points to"}, \
      {"ax", Kind::number, -1e100, 1e100, false, "direction of the axis, or the normal of the mirror"}, \
      {"ay", Kind::number, -1e100, 1e100, false, ""}, {"az", Kind::number, -1e100, 1e100, false, ""}, \
      {"x", Kind::number, -1e100, 1e100, false, "a point that stays; default 0 0 0"}, \
      {"y", Kind::number, -1e100, 1e100, false, ""}, {"z", Kind::number, -1e100, 1e100, false, ""}
#define BRICK "brick {x|=width} <width> [{y|=depth} <depth>] [{z|=height} <height>] [interval <n> [<n_y> <n_z>]]"
#define CYLINDER "cylinder {radius <radius> height <height>|height <height> radius <radius>} [interval <n>]"
#define SPHERE "sphere radius <radius> [interval <n>]"
#define SOLID_ARGUMENTS \
  {"width", Kind::number, 0, 1e100, true, "length along x"}, {"depth", Kind::number, 0, 1e100, true, "length along y"}, \
      {"height", Kind::number, 0, 1e100, true, "length along z"}, {"radius", Kind::number, 0, 1e100, true, "radius"}, \
      {"n", Kind::integer, 1, 1000, false, "number of cells; default 4, for a sphere 2"}, \
      {"n_y", Kind::integer, 1, 1000, false, ""}, {"n_z", Kind::integer, 1, 1000, false, ""}
#define SOLIDS \
  "All stand with their centre at the origin, a cylinder along z. A brick (y and z default to x) gets a mapped mesh " \
  "with n cells along each edge, or n, n_y and n_z along x, y and z; a cylinder an O-grid with n cells along its height and " \
  "each quarter circle; a sphere seven blocks with n cells along each eighth of a great circle. What was there before " \
  "is replaced."
#define FILTERS "[low <lowest>] [high <highest>] [top <n>] [bottom <n>]"
#define FILTER_ARGUMENTS \
  {"lowest", Kind::number, -1e300, 1e300, false, "only hexes with at least this value"}, \
      {"highest", Kind::number, -1e300, 1e300, false, "only hexes with at most this value"}, \
      {"n", Kind::integer, 1, 1e9, false, "how many hexes"}

const std::vector<CommandSpec> table = {
    {"block",
     "block {<id>|all} {{hex|volume|group} <range> ... [name <text>]|add {hex|volume|group} <range> ... [name <text>]"
     "|remove {hex|volume|group} <range> ...|name <text>|element type <type>"
     "|attribute {count <n>|index <index> {<value>|name <text>}|<value>}}",
     "define a block of hexes",
     "Adds the hexes to the block, which comes into being when it is not there, or takes them out of it. A block without "
     "hexes is deleted. Blocks may overlap; formats that can't say so keep a hex in its first block. Children of "
     "a hex belong to its blocks. 'attribute' is for Exodus files: so many values per hex of the block, each with a number "
     "(from 1), a value and a name.",
     {{"id", Kind::integer, 0, max_group_id, false, "number of the block"},
      {"range", Kind::range, 0, 0, false, range_help},
      {"text", Kind::string, 0, 0, false, "name, in quotes"},
      {"type", Kind::word, 0, 0, false, "hex8, hex20 or hex27: of the files that are written"},
      {"n", Kind::integer, 0, 1000, false, "how many attributes the hexes of the block have"},
      {"index", Kind::integer, 1, 1000, false, "which of them"},
      {"value", Kind::number, -1e300, 1e300, false, "for all hexes of the block"}},
     {"block 1 volume 2 name \"steel\"", "block 1 add hex 1 to 10", "block 1 add volume 1 hex 5 to 9", "block 1 remove hex 3", "block 1 name \"iron\"", "block 1 attribute count 2", "block 1 attribute index 2 0.5"}},
    {"brick", BRICK, "'create brick'", SOLIDS, {SOLID_ARGUMENTS}, {"brick x 10 interval 5"}, "create"},
    {"check", "check", "verify the mesh: conformity, orientation, ownership, distance from the CAD, volume",
     "Prints what was checked and fails when the mesh breaks a promise, naming ids.", {},
     {"check"}},
    {"create",
     "create {" BRICK "|" CYLINDER "|" SPHERE "|=group <name>|=block <id>}",
     "make a small CAD solid with a hex mesh on it",
     SOLIDS,
     {SOLID_ARGUMENTS, {"name", Kind::string, 0, 0, false, ""}, {"id", Kind::integer, 0, max_group_id, false, ""}},
     {"create brick x 10 y 5 z 2 interval 10 5 2", "create cylinder radius 2 height 10", "create sphere radius 1 interval 3"}},
    {"curve", "curve <range> {smooth " SCHEMES " [=free|=fixed] [=beta <value>] [=cpu <value>]|{name|=rename} <text>}", "name curves; choose how 'smooth' treats curves",
     "Nothing moves before 'smooth curve' is said, whose own 'scheme' goes before this.",
     {{"range", Kind::range, 0, 0, false, range_help}, {"value", Kind::number, 0, 1e100, false, ""}, {"text", Kind::string, 0, 0, false, "name, in quotes"}},
     {"curve all smooth scheme laplacian", "curve 3 name \"rim\""}},
    {"cylinder", CYLINDER, "'create cylinder'", SOLIDS, {SOLID_ARGUMENTS}, {"cylinder radius 2 height 10"}, "create"},
    {"delete", "delete {block|nodeset|sideset|group} <range>", "delete blocks, sets or groups", "Their members stay.",
     {{"range", Kind::range, 0, 0, false, range_help}},
     {"delete block 2", "delete nodeset all"}},
    {"coarsen",
     "coarsen {node|edge|face|hex|vertex|curve|surface|volume} <range> [levels <levels>] [depth <layers>] [radius <radius>] "
     "[sum <field> ...]",
     "take back levels of refinement",
     "Hexes become coarser by so many levels (default 1), as far as they were cut by 'refine' before: 27 become one again "
     "where all of them are named ('hex'), or where any of them touches or lies in the entities (all else). What was cut only for the "
     "transition around goes by itself once nothing needs it; with everything coarsened the mesh is the one that was there before "
     "the first 'refine', with its ids. Values of hexes become averages by volume, those of the fields after 'sum' are added up; nodes that stay keep theirs. 'refine' by "
     "sheets, layers, one into eight or the combination, and changes of blocks and sets, end what can be taken back: a note says so.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"levels", Kind::integer, 1, 100, false, "default 1"},
      {"layers", Kind::integer, 0, 1e6, false, "layers of hexes around the entities that become coarser too"},
      {"radius", Kind::number, 0, 1e100, false, "hexes whose centroid is that near to the entities"},
      {"field", Kind::string, 0, 0, false, "a field of hexes whose sum stays"}},
     {"coarsen hex all", "coarsen hex in field \"error\" bottom 20 %", "coarsen surface 3 levels 2"}},
    {"draw",
     "draw [{mesh|geometry|{node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range>}]"
     " [quality {" METRICS "}] [{color|=colour} {volume|surface|block|nodeset|sideset|group|sheet|<what>|<word>}] [clip {x|y|z|<nx> <ny> <nz>} [at <position>] [crinkle]]"
     " [label {node|edge|face|hex|vertex|curve|surface|volume}] [title <title>] [legend {on|off}] [from <x> <y> <z>]"
     " [pixels <width> <height>] to <file> [{overwrite|append}]",
     "draw the mesh into a picture or a page",
     "A .html is the viewer with the whole mesh inside: what the command is about is picked there, and hexes and faces are "
     "shown alone. All others are pictures, .svg is made of lines, and a .gif gets one more with 'append': hexes (of volumes, blocks, sheets) are seen from outside, faces (of surfaces, side "
     "sets) alone; edges and nodes (of curves, vertices, node sets) stand out from the mesh. Colours tell blocks, volumes or "
     "sheets apart, with 'quality' good from bad, or say what 'color' names: block, volume, surface, sheet, owner (of nodes), nodeset, "
     "sideset, group, level, template, changed (by the last change), a metric or a field. 'clip' takes away what is before a plane, with 'crinkle' whole hexes. 'label' "
     "writes ids. 'geometry' is the CAD itself, as is the whole where there is no mesh. 'from' is the direction to look from.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"what", Kind::string, 0, 0, false, "what gives the colours, in quotes"},
      {"word", Kind::word, 0, 0, false, "the same without quotes"},
      {"nx", Kind::number, -1e100, 1e100, false, "normal of the plane that clips"},
      {"ny", Kind::number, -1e100, 1e100, false, ""},
      {"nz", Kind::number, -1e100, 1e100, false, ""},
      {"position", Kind::number, -1e100, 1e100, false, "of the plane along its normal, from the origin; default: the middle of the mesh"},
      {"title", Kind::string, 0, 0, false, "stands above a picture, in quotes"},
      {"x", Kind::number, -1e100, 1e100, false, "from the mesh to the eye; default 1 -1 0.7, z is up"},
      {"y", Kind::number, -1e100, 1e100, false, ""},
      {"z", Kind::number, -1e100, 1e100, false, ""},
      {"width", Kind::integer, 16, 8000, false, "of a picture; default 1200 900"},
      {"height", Kind::integer, 16, 8000, false, ""},
      {"file", Kind::file, 0, 0, false, "file name that ends in .png, .svg, .gif or .html"}},
     {"draw to \"part.html\"", "draw volume 1 quality shape to \"part.png\" overwrite", "draw sheet 3 from 1 0 0 to \"sheet.png\"",
      "draw color \"temperature\" clip y at 2.5 title \"after 3 s\" to \"inside.png\"", "draw label curve to \"curves.png\""}},
    {"exit", "exit", "end the session", "", {}, {"exit"}, "quit"},
    {"export", "export {mesh|exodus|genesis|gmsh|vtk|abaqus|medit|med|nastran|unv|openfoam|lsdyna|ansys|nek|specfem|cgns|mfem|xdmf|vtkhdf|levels} <file> [overwrite] [{text|binary}] [version <version>] [groups only] [order <order>] [block <blocks>] [=partial] [=dimension <dimension>] [=everything]", "write the mesh to a file",
     "'mesh' chooses the format by the file's extension; the other words insist on one. The file is complete or, when "
     "something fails, as it was. An existing file is kept unless 'overwrite' is said. 'text' or 'binary' where a format has "
     "both (.msh, .vtu); 'version' of .msh; 'order 2' writes hexes of 20 nodes (27 where the blocks have those); 'groups only' writes to .msh what is in blocks and sets and nothing else, as some "
     "programs want it. 'levels' writes the base of the mesh and what was refined of it (not the mesh), so that 'coarsen' "
     "can go on another day.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"},
      {"version", Kind::number, 2.2, 4.1, false, "of .msh: 2.2 or 4.1; default 4.1"},
      {"blocks", Kind::range, 0, 0, false, "only these blocks, with what sets and fields have of them"},
      {"order", Kind::integer, 1, 2, false, "of the hexes: 2 with middle nodes, on the CAD where that bends"},
      {"dimension", Kind::integer, 3, 3, false, ""}},
     {"export gmsh \"part.msh\" text version 2.2 groups only", "export exodus \"part.e\"", "export vtk \"part.vtu\" overwrite", "export abaqus \"part.inp\" order 2"}},
    {"group",
     "group {<name>|<word>|<id>} {add|equals|remove|xor} {{node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet} <range> ..."
     "|quality {node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range> [{" METRICS "}] " FILTERS "}",
     "collect entities under a name",
     "For ranges: 'curve in group 1', 'refine curve in fillets'. 'add' makes the group if there is none of that name, 'equals' "
     "leaves nothing else in it, 'xor' adds those that are not in it and takes out the others. Members that a later command "
     "does away with, such as hexes that are split, are members no longer; blocks keep their children. 'quality' collects hexes as the command "
     "of that name prints them.",
     {{"name", Kind::string, 0, 0, false, "name of the group, in quotes"},
      {"word", Kind::word, 0, 0, false, "the same without quotes"},
      {"id", Kind::integer, 1, max_group_id, false, "number of a group that is there"},
      {"range", Kind::range, 0, 0, false, range_help}, FILTER_ARGUMENTS},
     {"group \"fillets\" add curve with radius > 0", "group \"fillets\" add surface 1 curve 2", "group \"fillets\" remove curve 3", "group \"poor\" add quality volume all shape high 0.3"}},
    {"help", "help [<command> [<option>]]", "list the commands, or show one, or one of its options",
     "", {{"command", Kind::word, 0, 0, false, "a command, 'range' or 'expressions'"}, {"option", Kind::word, 0, 0, false, "one of its options, or 'all' for everything about it"}}, {"help", "help refine", "help refine size", "help refine all"}},
    {"import", "import {mesh [=geometry]|exodus|gmsh|abaqus|vtk|medit|med|nastran|unv|openfoam|lsdyna|ansys|nek|specfem|cgns|mfem|xdmf|vtkhdf|levels|geometry|step|brep|iges} <file> [{snap|no_snap}] [=heal|=noheal|=no_heal] "
     "[=feature_angle <angle>] [=block <blocks>] [=no_geom] [=attributes_on|=attributes_off] [=separate_bodies] [scale <factor>] "
     "[=use] [=nodeset] [=no_nodeset] [=sideset] [=no_sideset] [=linear] [=gradient] [=quadratic] [=spline] [=merge] [=no_merge] "
     "[=merge_nodes] [=unique] [=genesis] [=start_id <start>] [=ids]", "read a mesh or CAD",
     "'mesh' and 'geometry' choose the format by the file's extension; the other words insist on one. CAD comes first, "
     "then the mesh that lies on it; a mesh without CAD gets a model of its own skin. A new mesh or CAD replaces the old one. "
     "Boundary nodes that lie off the CAD within the tolerance (files often keep six digits) are put on it, unless 'no_snap' is said. "
     "'levels' brings back what 'export levels' wrote, with the mesh; where that mesh is there already, with the results of a solver, its fields stay.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"},
      {"factor", Kind::number, 0, 1e100, true, "for all lengths in the file: 0.001 makes metres of millimetres"},
      {"angle", Kind::number, 0, 180, false, ""},
      {"start", Kind::integer, 0, 9e15, false, ""},
      {"blocks", Kind::range, 0, 0, false, ""}},
     {"import step \"part.step\"", "import mesh \"part.msh\"", "import mesh \"part.e\" scale 1000"}},
    {"list",
     "list [{model|=totals|undo|field|periodic|{node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range> [=geometry|=mesh|=ids|=position]}]",
     "show entities and their properties",
     "Without arguments: the model and mesh as a whole. One entity of the CAD: what it is, how large, its radius, centre and axis or direction, where "
     "it begins and ends, what it bounds, its box and groups; several: a table. 'field': the fields of the mesh. 'periodic': the surfaces that repeat others. 'undo': what can be "
     "undone, and the memory that it takes.",
     {{"range", Kind::range, 0, 0, false, range_help}},
     {"list", "list undo", "list field", "list curve all", "list curve loop of surface 3 (at 0 0 1)", "list hex in sheet 3", "list sheet in hex 17"}},
    {"merge", "merge {all|{node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|group} <range>} [tolerance <tolerance>]",
     "make coincident nodes one",
     "Nodes (all, or those of the entities) that lie within the tolerance of each other become the one with the lowest id, so that hexes which only "
     "touched share faces, and curves and surfaces between go. Blocks, sets, fields and other elements go on with it, and the mesh is put on its CAD anew. "
     "Refused where an edge of a hex would vanish, a face would have three hexes, or hexes would hang at others by some of their nodes. Of "
     "CAD without a mesh, 'merge all' glues touching solids, as 'set glue on' does when CAD is read.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"tolerance", Kind::number, 0, 1e100, false, "distance, model units; default: a millionth of the diagonal of the mesh"}},
     {"merge all", "merge all tolerance 0.001", "merge volume 1 2", "merge node in nodeset 3 4"}},
    {"mesh", "mesh volume <range> [{size <size>|interval <n>}]", "fill volumes of the CAD with hexes",
     "Volumes that can be swept: those whose surfaces, but for the caps at two ends, have four corners each or are tubes: boxes, extruded and "
     "turned solids, pipes, cylinders; and balls. Volumes that share a surface have the same quads there. What cannot be swept is refused, with the reason. Caps "
     "other than discs, rings and four-sided ones are paved by the program gmsh, where that is installed. 'size' is the length of edges, the default a "
     "fifteenth of the diagonal of the volumes; 'interval' so many along each curve, more where opposite curves, or bent ones, need it. "
     "Each volume becomes a block of its number. Touching solids are glued first, unless 'set glue off' was said.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"size", Kind::number, 0, 1e100, true, "length of edges, model units"},
      {"n", Kind::integer, 1, 100000, false, "intervals along each curve"}},
     {"mesh volume all", "mesh volume all size 0.5", "mesh volume 1 2 interval 8"}},
    {"move", "move {volume <range> {" ALONG "}|=model " WHERE_TO "|<dx> <dy> <dz>|" ALONG "} [=include_merged]", "move mesh and CAD",
     "Both together, with all volumes. Fields keep their values, and levels of refinement end: what is refined later cannot be "
     "coarsened beyond the mesh as it is now. Also 'volume all move x 10'.",
     {{"range", Kind::range, 0, 0, false, "all volumes"}, MOVE_ARGUMENTS}, {"move x 10", "move 1 0 -2"}},
    {"node", "node <range> position {fixed|free}", "fix nodes where they are, or free them",
     "Smoothing leaves fixed nodes alone, that of 'refine ... smooth' too, and the repair of inverted children. "
     "'list node' says which are fixed.",
     {{"range", Kind::range, 0, 0, false, range_help}},
     {"node in surface 3 position fixed", "node all position free"}},
    {"nodeset",
     "nodeset <id> {{node|edge|face|hex|vertex|curve|surface|volume|block|sideset|nodeset|group} <range> ... [name <text>]|add {node|edge|face|hex|vertex|curve|surface|volume|block|sideset|nodeset|group} <range> ... [name <text>]"
     "|remove {node|edge|face|hex|vertex|curve|surface|volume|block|sideset|nodeset|group} <range> ...|name <text>}",
     "define a node set",
     "Adds the nodes of the entities to the set, those on their rim too, or takes them out of it. New nodes belong "
     "to it on the curves and surfaces and in the volumes that it is meant to hold.",
     {{"id", Kind::integer, 0, max_group_id, false, "number of the set"},
      {"range", Kind::range, 0, 0, false, range_help},
      {"text", Kind::string, 0, 0, false, "name, in quotes"}},
     {"nodeset 3 curve 4", "nodeset 3 add node 7 9 name \"rim\"", "nodeset 2 curve 1 to 4 vertex 3 node 8", "nodeset 3 remove node in vertex all", "nodeset 3 name \"edge\""}},
    {"periodic",
     "periodic {off|surface <first> <second> [{move <dx> <dy> <dz>|angle <degrees> about {x|y|z|<ax> <ay> <az>|origin <x> <y> <z> direction <ax> <ay> <az>}}]}",
     "keep surfaces alike that repeat others",
     "The second surface repeats the first one, moved or turned: how is found from the mesh (a translation; for flat surfaces also a rotation about the line in which their "
     "planes meet), or said. From then on whatever is refined on one side is refined on the other, and "
     "nodes of the second lie where those of the first are taken; what can't keep that is refused. Of a .msh with periodic "
     "surfaces this holds as soon as it is read, and they are written again. 'list periodic' shows the pairs, 'off' lets all go.",
     {{"first", Kind::integer, 1, 1e9, false, "the surface that decides"}, {"second", Kind::integer, 1, 1e9, false, "the one that repeats it"}, MOVE_ARGUMENTS},
     {"periodic surface 1 2", "periodic surface 1 2 move 0 0 10", "periodic surface 1 2 angle 60 about z", "periodic off"}},
    {"playback", "playback <file>", "run the commands in a journal file",
     "Stops at the first error; what the commands before it did stays done.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"}}, {"playback \"part.jou\""}},
    {"project", "project {to|=onto} geometry [<file>] [within <distance>]", "put the mesh on its CAD, or on another",
     "Boundary nodes go to their curves and surfaces; hexes that this would turn inside out are repaired by moving the nodes near them, or nothing "
     "is done. With a file the CAD there takes the place of the one that was: a version that has changed a little, with the same curves and "
     "surfaces. Prints per surface how many nodes moved, how far, and what became of the worst hex.",
     {{"file", Kind::file, 0, 0, false, "CAD file, in quotes when it has blanks"},
      {"distance", Kind::number, 0, 1e100, true, "how far a node may be from its place; default: a hundredth of the size of the CAD"}},
     {"project to geometry", "project to geometry \"part2.step\" within 0.5"}},
    {"quality",
     "quality {node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range> "
     "[{" METRICS "|all|=allmetrics|=allmetric}] [histogram] " FILTERS " [list] "
     "[=global] [=individual] [=draw] [=mesh] [=monochrome] [=add] [=detail] [=id] [=summary] [=geometry] [=verbose] [=errors] [=filter]",
     "print the quality of hexes",
     "Count, average, standard deviation, smallest and largest value with their hexes, over the hexes of (or touching) "
     "the entities. Without a metric: shape, 1 for a cube, 0 where flat; 'all': every one. The values are those of "
     "Verdict, so of VTK and ParaView. 'low' and 'high' leave out hexes with smaller or larger values; 'top' and 'bottom' "
     "keep the n largest or smallest values of those; 'list' prints the ids of the hexes that are left, 'histogram' shows "
     "how the values are spread. Where 'in' comes before it, write edge_ratio in one word, and volume after another option.",
     {{"range", Kind::range, 0, 0, false, range_help}, FILTER_ARGUMENTS},
     {"quality volume all", "quality hex 1 to 200 scaled jacobian", "quality surface 3 all",
      "quality volume all condition number histogram", "quality volume 1 skew low 0.5", "quality volume all bottom 10 list"}},
    {"quit", "quit", "end the session", "", {}, {"quit"}},
    {"record", "record {stop|<file> [{overwrite|append}]}", "write the commands that succeed to a journal",
     "One line for each, as it was typed; of a journal that is played back, its commands. An existing file is kept unless "
     "'overwrite' or 'append' is said.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"}},
     {"record \"part.jou\"", "record stop"}},
    {"redo", "redo [<steps>]", "do again what was undone", "Possible until another command changes the mesh or the CAD.",
     {{"steps", Kind::integer, 1, 1e9, false, "how many; default 1"}},
     {"redo", "redo 2"}},
    {"refine",
     "refine {{{node|edge|face|hex|vertex|curve|surface|volume} <range>|location <x> <y> <z>} "
     "[numsplit <splits>] [size <size>] [bias <growth>] [depth <layers>] [radius <radius>] [concave {template|fill}] "
     "[method {auto|single|parallel|combination}] [{smooth|no_smooth}] [dry_run] [allow off_cad] "
     "[sizing_function [<function>] [<expression>]] [direction {thickness|layers <n> [growth <ratio>]}] [transition {regular|nested}] [graded] [sum <field> ...] [stop_at other] [using {curve|surface|volume|block|sideset|nodeset|group} <which>]"
     "|sheet {edge <range>|node <first> <second>|intersect edge <range>} [{greater_than <length>|factor <multiple>}] "
     "[concave {template|fill}] [{smooth|no_smooth}] [dry_run] [allow off_cad] [sum <field> ...]}",
     "split hexes at entities of the mesh or the CAD, keeping the mesh conforming",
     "Each edge of the target is cut in three, 'numsplit' times over. With depth 0 exactly the target is refined, with 1 "
     "every hex that touches it, with 2 one layer more. The default is 0, which for a node, edge, face, vertex, curve or "
     "surface is 'method combination': it stays within the elements that touch the target. 'method single' is depth 1 "
     "unless told otherwise; 'method parallel' halves the edges that leave the target. Of hexes, volumes and with depth 1 or more, "
     "'method parallel' makes one into eight instead of 27 wherever the sheets of a region allow it. 'smooth' moves the new nodes, and those of two "
     "layers around them, to better shapes. "
     "'size' cuts until the elements at the target are about as large, each edge within a factor of sqrt(3), by threes, or by "
     "twos as well, or by the combination in the last passes, where 'method auto' finds that nearer; with a "
     "'bias' above 1 the wished size grows with the distance from the target by about that factor from element to "
     "element, and all hexes are looked at. 'sizing_function' takes the size from a function of place, in the hexes of the "
     "target; with a 'bias' it is lowered until sizes grow by no more than that. 'radius' takes the hexes whose centroid is that near to the target. "
     "All volumes of the model together are refined uniformly instead: each edge in numsplit + 1 pieces.\n"
     "'direction thickness' cuts only the edges that leave the surfaces or faces, and on from hex to hex to the other side; "
     "'direction layers' cuts the hexes at the target into layers along it, each thicker than the one before by 'growth'. "
     "'refine sheet' cuts only across the hex sheets of the edges (of the edge between two nodes; 'intersect': the other "
     "sheets of the hexes around the edges), where the edges are longer than a length, or than a multiple of the sheets' "
     "shortest edge. 'transition regular' (the default) never cuts pieces of the transition around a refinement "
     "again: the cell that they are pieces of is cut instead, so that shapes do not depend on how often and in which order "
     "is refined; 'nested' cuts them like all others. 'graded' also keeps the hex field \"level\". Children have the values of the hex that "
     "they lie in; those of the fields after 'sum' are shared out by volume.\n"
     "Where the region is concave, 'concave template' uses templates made for that, 'concave fill' grows the region "
     "until it is convex. New nodes lie on the CAD. A result that would be inverted, or "
     "that has a node that can't be put on the CAD, is refused, and the mesh stays as it was; 'allow off_cad' accepts such nodes, with a note. "
     "Elements beside the hexes stay as they are, but for quads that are faces of hexes and lines that are edges, which are cut with them. "
     "A refinement that would cut an edge of another one is refused; 'stop_at other' leaves out as many layers of the target as it takes.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"x", Kind::number, -1e100, 1e100, false, "of a point: hexes whose middle is within the radius"},
      {"y", Kind::number, -1e100, 1e100, false, ""},
      {"z", Kind::number, -1e100, 1e100, false, ""},
      {"which", Kind::range, 0, 0, false, "only what of the target lies in these, or touches them"},
      {"splits", Kind::integer, 1, max_uniform_pieces - 1, false, "how often each target edge is cut in three; default 1, at most 8 unless all volumes are refined"},
      {"layers", Kind::integer, 0, 1e6, false, "layers of hexes around the target that are refined fully too"},
      {"size", Kind::number, 0, 1e100, true, "wished size of elements at the target"},
      {"growth", Kind::number, 1, 1e100, false, "growth of the wished size from element to element; default 1: none, the size is for the target alone"},
      {"radius", Kind::number, 0, 1e100, false, "hexes whose centroid is that near to the target"},
      {"function", Kind::word, 0, 0, false, "a sizing function; default: the one defined last"},
      {"expression", Kind::string, 0, 0, false, "a size in x, y and z: \"0.1 + 0.2*abs(x)\""},
      {"n", Kind::integer, 1, 50, false, "number of layers"},
      {"ratio", Kind::number, 0.1, 10, false, "thickness of a layer / that of the one nearer to the target; default 1"},
      {"first", Kind::integer, 1, 9e15, false, "id of a node"},
      {"second", Kind::integer, 1, 9e15, false, "id of the node at the other end of the edge"},
      {"length", Kind::number, 0, 1e100, false, "only edges longer than this"},
      {"multiple", Kind::number, 0, 1e100, false, "only edges longer than this times the shortest"},
      {"field", Kind::string, 0, 0, false, "a field of hexes whose sum stays"}},
     {"refine curve 3", "refine curve 3 size 0.5 bias 1.5", "refine curve 3 size 0.5 depth 0", "refine vertex 2 radius 4 numsplit 2",
      "refine volume all sizing_function \"0.5 + 0.1*abs(x)\"", "refine surface 1 to 4 numsplit 2 depth 1", "refine hex in volume 2 concave fill", "refine curve 7 smooth",
      "refine volume all numsplit 1", "refine sheet edge 12 greater_than 0.5", "refine sheet node 1 2",
      "refine surface 3 direction layers 4 growth 1.3", "refine hex in field \"error\" top 5 % graded",
      "refine location 0 0 2.5 radius 2", "refine volume 1 using surface 7"}},
    {"reflect", "reflect {volume <range> {x|y|z|about {x|y|z|<ax> <ay> <az>}}|model [=about] {x|y|z|<ax> <ay> <az>}} [=include_merged]", "mirror mesh and CAD",
     "At a plane through the origin, given by its normal. What is kept: see 'help move'.",
     {{"range", Kind::range, 0, 0, false, "all volumes"}, MOVE_ARGUMENTS}, {"reflect model x"}, {}, false},
    {"reset", "reset [{mesh|block|nodeset|sideset|=genesis}]", "forget the mesh and the CAD, or all blocks or sets",
     "'reset mesh' leaves the CAD, for 'mesh volume' or another mesh.", {},
     {"reset", "reset mesh", "reset nodeset"}},
    {"rotate", "rotate {volume <range> angle <degrees>|model [=angle] <degrees>} about {x|y|z|<ax> <ay> <az>|origin <x> <y> <z> direction <ax> <ay> <az>} [=include_merged]",
     "turn mesh and CAD", "About an axis through the origin, or through a point. What is kept: see 'help move'.",
     {{"range", Kind::range, 0, 0, false, "all volumes"}, MOVE_ARGUMENTS}, {"rotate model 90 about z"}},
    {"scale", "scale {volume <range> factor <factor>|=model <factor>|<factor>} [about <x> <y> <z>]", "scale mesh and CAD",
     "All lengths, from the origin or from a point. Only the mesh or only the CAD is scaled when it is read: 'import mesh \"part.e\" "
     "scale 1000'. What is kept: see 'help move'.",
     {{"range", Kind::range, 0, 0, false, "all volumes"}, MOVE_ARGUMENTS}, {"scale 0.001"}},
    {"set", "set {glue {auto|on|off}|feature_angle <degrees>|tolerance <limit>|threads <count>|undo {on|off|limit <megabytes>}|order <order>"
     "|max_hexes <most>|max_memory <gigabytes>|reading {fenced {on|off}|time <seconds>|memory <megabytes>}|safe on|untangle {on|off}|snap {on|off}|keep_jumps {off|<field>}|=duplicate block elements {on|off}}",
     "change a setting",
     "glue: whether touching solids of a CAD file share their faces; 'auto' (the default) does so when the mesh does. "
     "order: of meshes that are written, 2 with middle nodes (default: as the mesh was read). "
     "feature_angle: an edge of a mesh without CAD is a curve where its faces turn by more (default 35). "
     "tolerance: how far a mesh may lie off its CAD, relative to the model size (default 1e-5). threads: 0 for all cores. "
     "undo: whether commands can be undone, and the memory for that (default 1000 MB; the oldest go first). max_hexes, max_memory: "
     "what would make a larger mesh or take more is refused (0: whatever the machine has). "
     "reading: whether CAD and Exodus files are read in a process of their own, which a damaged file cannot take this one down with "
     "(default: where the programs for it are installed), and what such a file may take: seconds of CPU time and MB of memory (0, the default: by "
     "its size). safe: from then on, and for good, commands read and write only files below the working folder, with the endings of their kinds, "
     "and files are read in a process of their own. untangle: "
     "whether a mesh that is read with inverted hexes is untangled (default) or refused. snap: whether nodes of a mesh that is "
     "read are put on the CAD (default). keep_jumps: a hex field whose jumps smoothing leaves in place, as it does block boundaries.",
     {{"degrees", Kind::number, 0, 180, false, "angle in degrees"},
      {"limit", Kind::number, 0, 1, true, "relative to the model size"},
      {"count", Kind::integer, 0, 1024, false, "number of threads"},
      {"megabytes", Kind::number, 0, 1e9, false, "memory, in MB"},
      {"seconds", Kind::number, 0, 1e9, false, "seconds"},
      {"order", Kind::integer, 1, 2, false, "1 or 2"},
      {"most", Kind::integer, 0, 9e15, false, "hexes of a mesh at most"},
      {"gigabytes", Kind::number, 0, 1e9, false, "memory of the program, in GB"},
      {"field", Kind::string, 0, 0, false, "name of a hex field, in quotes"}},
     {"set keep_jumps \"grain\"", "set glue on", "set undo limit 200", "set max_hexes 2000000", "set reading time 300", "set feature_angle 20"}},
    {"sideset",
     "sideset <id> {{face|surface|group} <range> ... [wrt {volume|block|hex} <which>] [{forward|reverse|both}] [name <text>]"
     "|add {face|surface|group} <range> ... [wrt {volume|block|hex} <which>] [{forward|reverse|both}] [name <text>]"
     "|remove {face|surface|group} <range> ... [wrt {volume|block|hex} <which>] [{forward|reverse|both}]|name <text>}",
     "define a side set",
     "Adds the sides of hexes at the faces, or takes them out of the set. A face between two hexes has two sides: "
     "'forward' (the default) is that of the volume with the lower id (within a volume, of the hex with the lower id), "
     "'reverse' the other; 'wrt' takes those of the hexes named.",
     {{"id", Kind::integer, 0, max_group_id, false, "number of the set"},
      {"range", Kind::range, 0, 0, false, range_help},
      {"which", Kind::range, 0, 0, false, "whose side of the faces"},
      {"text", Kind::string, 0, 0, false, "name, in quotes"}},
     {"sideset 5 surface 6", "sideset 5 face in surface 6 name \"wall\"", "sideset 7 surface 4 wrt volume 2", "sideset 3 surface 1 2 face 7", "sideset 5 remove face 3"}},
    {"sizing",
     "sizing {function <name> {constant <size>|<expression>|field <field> [file <file>]"
     "|curvature <per_radian> [{curve|surface} <range>] [growth <growth>]|interval <n> curve <range> [growth <growth>]"
     "|linear {node|edge|face|hex|vertex|curve|surface|volume} <range> size <size> [growth <growth>]"
     "|minimum <first> <second> [<third> [<fourth>]]}|field <field> [file <file>]|list}",
     "define a sizing function for 'refine ... sizing_function'",
     "constant: the same everywhere. An expression in x, y and z in quotes. field: the values of a nodal or element "
     "field of the mesh as it is now, or of a mesh file, interpolated. curvature: so many elements per radian on curved "
     "curves and surfaces (of the whole CAD or those named; of a mesh without CAD estimated from its faces). interval: so many elements along each curve. linear: a size "
     "at entities. From curves, surfaces and sources sizes grow by 'growth' (default 1.5) from element to element. minimum: "
     "the smallest of functions defined before. 'sizing field' makes a function of the field's name. 'sizing list' lists them.",
     {{"name", Kind::word, 0, 0, false, "what to call it"},
      {"size", Kind::number, 0, 1e100, true, "size of elements"},
      {"expression", Kind::string, 0, 0, false, "a size in x, y and z"},
      {"field", Kind::string, 0, 0, false, "name of a field, in quotes"},
      {"file", Kind::file, 0, 0, false, "a mesh file"},
      {"per_radian", Kind::number, 0, 1e6, true, "elements per radian"},
      {"range", Kind::range, 0, 0, false, range_help},
      {"growth", Kind::number, 1, 1e100, false, "growth of sizes from element to element"},
      {"n", Kind::integer, 1, 1e6, false, "number of elements"},
      {"first", Kind::word, 0, 0, false, "a sizing function"},
      {"second", Kind::word, 0, 0, false, ""},
      {"third", Kind::word, 0, 0, false, ""},
      {"fourth", Kind::word, 0, 0, false, ""}},
     {"sizing function f \"0.1 + 0.2*abs(x)\"", "sizing function bend curvature 3 growth 1.3",
      "sizing function near linear curve 3 size 0.5 growth 1.5", "sizing function all minimum f bend",
      "sizing field \"error size\" file \"solution.vtu\""}},
    {"smooth",
     "smooth {node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range> "
     "[" SCHEMES "] [iterations <sweeps>] [boundary {slide|fixed}]",
     "move nodes to better shapes of the hexes around them",
     "The nodes of the entities move, those on curves and surfaces along these, those on vertices and fixed ones (see "
     "'node') not at all. The smallest shape around them never falls. 'mean ratio', the default, is about shape: the "
     "worst hexes first, then the average; 'condition number' likewise in its own measure; 'laplacian' is quick; "
     "'untangle' only turns inverted hexes right. 'boundary fixed' moves nodes inside volumes only.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"sweeps", Kind::integer, 0, 1e6, false, "how often each node is visited at most; default 100"}},
     {"smooth volume all", "smooth hex in surface 3 scheme condition number", "smooth volume 1 iterations 5 boundary fixed"}},
    {"sphere", SPHERE, "'create sphere'", SOLIDS, {SOLID_ARGUMENTS}, {"sphere radius 1 interval 3"}, "create"},
    {"step", "step {<n>|last|time <t>}", "take the fields of another time step",
     "Of the file that the mesh came from, Exodus II only: its fields at that time, at the places where nodes and hexes are now. "
     "A file that is written has all time steps in any case.",
     {{"n", Kind::integer, 1, 1e9, false, "number of the step"},
      {"t", Kind::number, -1e100, 1e100, false, "its time, or the nearest one"}},
     {"step 1", "step time 2.5", "step last"}},
    {"surface", "surface <range> {smooth " SCHEMES " [=free|=fixed] [=beta <value>] [=cpu <value>]|{name|=rename} <text>}", "name surfaces; choose how 'smooth' treats surfaces",
     "Nothing moves before 'smooth surface' is said, whose own 'scheme' goes before this.",
     {{"range", Kind::range, 0, 0, false, range_help}, {"value", Kind::number, 0, 1e100, false, ""}, {"text", Kind::string, 0, 0, false, "name, in quotes"}},
     {"surface 3 smooth scheme condition number", "surface 3 name \"inlet\""}},
    {"undo", "undo [<steps>] [=on] [=off]", "take back what commands changed",
     "Mesh, CAD, blocks and sets, fixed nodes; settings stay. 'list undo' shows what can be undone and the memory that "
     "takes; 'set undo' limits it or switches it off.",
     {{"steps", Kind::integer, 1, 1e9, false, "how many; default 1"}},
     {"undo", "undo 3"}},
    {"vertex", "vertex <range> {name|=rename} <text>", "name vertices", "", {{"range", Kind::range, 0, 0, false, range_help}, {"text", Kind::string, 0, 0, false, "name, in quotes"}},
     {"vertex 1 name \"tip\""}},
    {"volume", "volume <range> {smooth " SCHEMES " [=free|=fixed] [=beta <value>] [=cpu <value>]|{name|=rename} <text>|" MOVES "}", "name, or move, the volumes; choose how 'smooth' treats volumes",
     "Nothing moves before 'smooth volume' is said, whose own 'scheme' goes before this. 'move', 'scale', 'rotate' and 'reflect' move mesh and CAD together, all volumes at once: see 'help move'.",
     {{"range", Kind::range, 0, 0, false, range_help}, {"value", Kind::number, 0, 1e100, false, ""}, {"text", Kind::string, 0, 0, false, "name, in quotes"}, MOVE_ARGUMENTS},
     {"volume 1 2 smooth scheme mean ratio", "volume 1 name \"core\"", "volume all move x 10"}},
};
// clang-format on

}  // namespace

std::span<const CommandSpec> language() {
  return table;
}

}  // namespace hextwist
