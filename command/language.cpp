// The table of all commands. Adding one means adding a row here and a function in the session.

#include "hextwist/command/syntax.h"

namespace hextwist {
namespace {

using Kind = ArgumentSpec::Kind;

constexpr std::string_view range_help = "ids: 1 3, 3 to 17 by 2, all, except ..., in ..., with ...; see 'help range'";

// clang-format off
const std::vector<CommandSpec> table = {
    {"block", "", "define a block of hexes", "", {}, {}},
    {"check", "check", "verify the mesh: conformity, orientation, ownership, distance from the CAD, volume",
     "Prints what was checked and fails when the mesh breaks a promise, naming ids.", {},
     {"check"}},
    {"create",
     "create {brick x <width> [y <depth>] [z <height>] [interval <n> [<n_y> <n_z>]]"
     "|cylinder {radius <radius> height <height>|height <height> radius <radius>} [interval <n>]"
     "|sphere radius <radius> [interval <n>]}",
     "make a small CAD solid with a hex mesh on it",
     "All stand with their centre at the origin, a cylinder along z. A brick (y and z default to x) gets a mapped mesh "
     "with n cells along each edge, or n, n_y and n_z along x, y and z; a cylinder an O-grid with n cells along its height and "
     "each quarter circle; a sphere seven blocks with n cells along each eighth of a great circle. What was there before "
     "is replaced.",
     {{"width", Kind::number, 0, 1e100, true, "length along x"},
      {"depth", Kind::number, 0, 1e100, true, "length along y"},
      {"height", Kind::number, 0, 1e100, true, "length along z"},
      {"radius", Kind::number, 0, 1e100, true, "radius"},
      {"n", Kind::integer, 1, 1000, false, "number of cells; default 4, for a sphere 2"},
      {"n_y", Kind::integer, 1, 1000, false, ""},
      {"n_z", Kind::integer, 1, 1000, false, ""}},
     {"create brick x 10 y 5 z 2 interval 10 5 2", "create cylinder radius 2 height 10", "create sphere radius 1 interval 3"}},
    {"draw", "", "draw the mesh into a file", "", {}, {}},
    {"exit", "exit", "end the session", "", {}, {"exit"}, "quit"},
    {"export", "export {mesh|exodus|genesis|gmsh|vtk|abaqus|medit} <file> [overwrite]", "write the mesh to a file",
     "'mesh' chooses the format by the file's extension; the other words insist on one. The file is complete or, when "
     "something fails, as it was. An existing file is kept unless 'overwrite' is said.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"}},
     {"export exodus \"part.e\"", "export vtk \"part.vtu\" overwrite"}},
    {"help", "help [<command>]", "list the commands, or show one",
     "", {{"command", Kind::word, 0, 0, false, "a command, or 'range'"}}, {"help", "help refine"}},
    {"import", "import {mesh|exodus|gmsh|abaqus|vtk|medit|geometry|step|brep|iges} <file>", "read a mesh or CAD",
     "'mesh' and 'geometry' choose the format by the file's extension; the other words insist on one. CAD comes first, "
     "then the mesh that lies on it; a mesh without CAD gets a model of its own skin. A new mesh or CAD replaces the old one.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"}},
     {"import step \"part.step\"", "import mesh \"part.msh\""}},
    {"list",
     "list [{model|{node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet|group} <range>}]",
     "show entities and their properties", "Without arguments: the model and mesh as a whole.",
     {{"range", Kind::range, 0, 0, false, range_help}},
     {"list", "list curve all", "list hex in sheet 3", "list sheet in hex 17"}},
    {"node", "", "fix or free nodes", "", {}, {}},
    {"nodeset", "", "define a node set", "", {}, {}},
    {"playback", "playback <file>", "run the commands in a journal file",
     "Stops at the first error; what the commands before it did stays done.",
     {{"file", Kind::file, 0, 0, false, "file name, in quotes when it has blanks"}}, {"playback \"part.jou\""}},
    {"quality",
     "quality {node|edge|face|hex|vertex|curve|surface|volume|block|nodeset|sideset|sheet} <range> "
     "[{shape|scaled [jacobian]|=scaled_jacobian|mean [ratio]|=mean_ratio|condition [number]|=condition_number|skew"
     "|stretch|taper|aspect [ratio]|=aspect_ratio|edge [ratio]|=edge_ratio|diagonal|relative [size]|=relative_size|shear"
     "|oddy|distortion|volume|jacobian|dimension|all}] [histogram] [low <lowest>] [high <highest>]",
     "print the quality of hexes",
     "Count, average, standard deviation, smallest and largest value with their hexes, over the hexes of (or touching) "
     "the entities. Without a metric: shape, 1 for a cube, 0 where flat; 'all': every one. The values are those of "
     "Verdict, so of VTK and ParaView. 'low' and 'high' leave out hexes with smaller or larger values; 'histogram' shows "
     "how the values are spread. Where 'in' comes before it, write edge_ratio in one word, and volume after another option.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"lowest", Kind::number, -1e300, 1e300, false, "only hexes with at least this value"},
      {"highest", Kind::number, -1e300, 1e300, false, "only hexes with at most this value"}},
     {"quality volume all", "quality hex 1 to 200 scaled jacobian", "quality surface 3 all",
      "quality volume all condition number histogram", "quality volume 1 skew low 0.5"}},
    {"quit", "quit", "end the session", "", {}, {"quit"}},
    {"record", "", "write commands to a journal", "", {}, {}},
    {"redo", "", "do again what was undone", "", {}, {}},
    {"refine",
     "refine {node|edge|face|hex|vertex|curve|surface|volume|~sheet} <range> "
     "[numsplit <splits>] [depth <layers>] [bias <growth>] [concave {template|fill}] [method {auto|single|parallel|combination}] "
     "[{smooth|no_smooth}] [dry_run] [~size] [~radius] [~sizing_function] [~direction]",
     "split hexes at entities of the mesh or the CAD, keeping the mesh conforming",
     "Each edge of the target is cut in three, 'numsplit' times over. With depth 0 exactly the target is refined, with 1 "
     "every hex that touches it, with 2 one layer more; the default is 0 for hexes and volumes, 1 for everything else. "
     "Depth 0 of a node, edge, face, vertex, curve or surface is 'method combination', which stays within the elements "
     "that touch it; 'method parallel' halves the edges that leave it. Of hexes, volumes and with depth 1 or more, "
     "'method parallel' makes one into eight instead of 27 wherever the sheets of a region allow it. 'smooth' moves the new nodes, and those of two "
     "layers around them, to better shapes. "
     "All volumes of the model together are refined uniformly instead: each edge in numsplit + 1 pieces.\n"
     "Where the region is concave, 'concave template' uses templates made for that, 'concave fill' grows the region "
     "until it is convex. New nodes lie on the CAD. A result that would be inverted is refused, and the mesh stays as it was.",
     {{"range", Kind::range, 0, 0, false, range_help},
      {"splits", Kind::integer, 1, 29, false, "how often each target edge is cut in three; default 1, at most 8 unless all volumes are refined"},
      {"layers", Kind::integer, 0, 1e6, false, "layers of hexes around the target that are refined fully too"},
      {"growth", Kind::number, 1, 1e100, false, "accepted when 1"}},
     {"refine curve 3", "refine surface 1 to 4 numsplit 2 depth 1", "refine hex in volume 2 concave fill", "refine curve 7 depth 0 smooth",
      "refine volume all numsplit 1"}},
    {"reset", "reset", "forget the mesh and the CAD", "", {}, {"reset"}},
    {"set", "set {glue {auto|on|off}|feature_angle <degrees>|tolerance <limit>|threads <count>}", "change a setting",
     "glue: whether touching solids of a CAD file share their faces; 'auto' (the default) does so when the mesh does. "
     "feature_angle: an edge of a mesh without CAD is a curve where its faces turn by more (default 35). "
     "tolerance: how far a mesh may lie off its CAD, relative to the model size (default 1e-5). threads: 0 for all cores.",
     {{"degrees", Kind::number, 0, 180, false, "angle in degrees"},
      {"limit", Kind::number, 0, 1, true, "relative to the model size"},
      {"count", Kind::integer, 0, 1024, false, "number of threads"}},
     {"set glue on", "set feature_angle 20"}},
    {"sideset", "", "define a side set", "", {}, {}},
    {"smooth", "", "improve the shape of hexes", "", {}, {}},
    {"undo", "", "take back a command", "", {}, {}},
};
// clang-format on

}  // namespace

std::span<const CommandSpec> language() {
  return table;
}

}  // namespace hextwist
