#include "hextwist/command/foreign.h"

#include <algorithm>

#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"

namespace hextwist {
namespace {

struct Row {
  /// Words that the line begins with; * stands for anything in between, a|b for either.
  std::string_view pattern;
  bool is_skipped;
  std::string_view text;
};

constexpr bool skipped = true, refused = false;

constexpr std::string_view needs_no_display =
    "nothing is shown here; 'draw ... to \"part.html\"' makes a page, or a picture";
constexpr std::string_view logged = "'record \"part.jou\"' writes a journal, '--json' a report";
constexpr std::string_view measured = "'list' prints lengths, areas, radii and places";
constexpr std::string_view meshing =
    "volumes are meshed with all that bounds them, where they can be swept: 'mesh volume all size 0.5', or 'interval "
    "8' "
    "along each curve; other meshes are read ('import mesh \"part.e\"')";
constexpr std::string_view geometry =
    "geometry is not edited here: read it as it should be ('import step \"part.step\"'), then the mesh on it";
constexpr std::string_view solids =
    "solids are made by 'create brick', 'create cylinder' and 'create sphere', others are read";
constexpr std::string_view hexes = "meshes are all-hexahedral here";
constexpr std::string_view loads =
    "loads and materials are for the solver's own input; 'block', 'nodeset' and 'sideset' make what they refer to";
constexpr std::string_view cub =
    ".cub and .cub5 files are not known here: 'export mesh \"part.e\"' writes the mesh, 'record' a journal";

// The first row that fits counts. No text: a command of ours, whose own error is the better one.
constexpr Row foreign_words[] = {
    {"draw * to", refused, {}},
    {"volume|surface|curve|vertex|body * smooth", refused, {}},
    {"block * element|name", refused, {}},
    {"rotate volume|model", refused, {}},
    {"rotate", skipped, needs_no_display},

    {"graphics", skipped, needs_no_display},
    {"display", skipped, needs_no_display},
    {"draw", skipped, needs_no_display},
    {"view", skipped, needs_no_display},
    {"zoom", skipped, needs_no_display},
    {"pan", skipped, needs_no_display},
    {"color|colour", skipped, needs_no_display},
    {"label", skipped, needs_no_display},
    {"highlight", skipped, needs_no_display},
    {"transparent", skipped, needs_no_display},
    {"hardcopy", skipped, needs_no_display},
    {"from", skipped, needs_no_display},
    {"at", skipped, needs_no_display},
    {"up", skipped, needs_no_display},
    {"camera", skipped, needs_no_display},
    {"mouse", skipped, needs_no_display},
    {"visibility", skipped, needs_no_display},
    {"volume|surface|curve|vertex|body|node|hex|group|block * visibility|color|label", skipped, needs_no_display},
    {"locate", skipped, measured},
    {"measure", skipped, measured},
    {"cd", skipped, "the working folder stays where the program was started"},
    {"pwd|ls|history", skipped, {}},
    {"pause", skipped, {}},
    {"sleep", skipped, {}},
    {"echo", skipped, {}},
    {"comment", skipped, {}},
    {"title", skipped, {}},
    {"compress", skipped, "ids stay as they are"},
    {"renumber", skipped, "ids stay as they are"},
    {"version", skipped, {}},
    {"timer", skipped, {}},
    {"cubitgui", skipped, {}},
    {"journal", skipped, logged},
    {"logging", skipped, logged},
    {"info|warning|error|debug|errors|warnings on|off", skipped, logged},
    {"set echo|info|information|warning|error|errors|debug|journal|logging|comment", skipped, logged},
    {"set large|exodus|netcdf4", skipped, "files are written in the format that suits their size"},
    {"set "
     "default|node|developer|attribute|geometry|digits|proximity|paver|overlap|dev|multisweep|trimesher|merge|graphics|"
     "picking|maximum|minimum|parallel|hex|tetmesher|max|color|colour",
     skipped, "it sets up a mesher or its display"},
    {"save", skipped, cub},
    {"group cleanup", skipped, {}},
    {"topology check", skipped, "'check' verifies the mesh"},

    {"open", refused, cub},
    {"import cubit", refused,
     ".cub files cannot be read: write the mesh there as Exodus (.e) and the geometry as STEP"},
    {"import "
     "acis|sat|parasolid|catia|pro_e|solidworks|nx|inventor|granite|jt|facets|stl|avs|ideas|patran|nastran|fluent",
     refused,
     "this format is not read here: CAD comes as .step, .brep or .iges, a mesh as .e, .msh, .inp, .vtk, .vtu or .mesh"},
    {"import sizing", refused, "say 'sizing field \"name\" file \"solution.e\"', then 'refine ... sizing_function'"},
    {"export acis|step|iges|stl|parasolid|facets|ideas|patran|nastran|fluent|cubit|avs|sat", refused,
     "meshes are written as exodus, gmsh, vtk, abaqus or medit here"},
    {"mesh volume", refused, {}},
    {"mesh", refused, meshing},
    {"remesh", refused, meshing},
    {"unmesh", refused, meshing},
    {"htet", refused, hexes},
    {"thex", refused, hexes},
    {"dice", refused, "say 'refine volume all numsplit 1' for all hexes cut alike"},
    {"propagate", refused, meshing},
    {"match", refused, meshing},
    {"volume|surface|curve|vertex|body * size|interval|scheme|sizing|meshable|tetmesh|redistribute", refused, meshing},
    {"delete mesh", refused,
     "'reset mesh' drops the mesh, 'reset' the CAD as well; hexes cannot be taken out of a mesh here"},
    {"delete volume|surface|body|curve|vertex|hex|node|edge|face|element", refused,
     "a part of a mesh or model cannot be taken out here; 'export ... block 1 partial' writes a part, 'reset' drops "
     "all"},
    {"webcut", refused, geometry},
    {"chop", refused, geometry},
    {"section", refused, geometry},
    {"imprint", refused,
     "touching solids are glued when CAD is read: 'set glue on' before 'import step \"part.step\"'"},
    {"unmerge", refused, "'set glue off' before the CAD is read keeps its solids apart"},
    {"unite", refused, geometry},
    {"subtract", refused, geometry},
    {"intersect", refused, geometry},
    {"split", refused, geometry},
    {"sweep", refused, geometry},
    {"tweak", refused, geometry},
    {"remove", refused, geometry},
    {"collapse", refused, geometry},
    {"composite", refused, geometry},
    {"partition", refused, geometry},
    {"simplify", refused, geometry},
    {"regularize", refused, geometry},
    {"heal|healer", refused, "CAD is healed when it is read"},
    {"align", refused, geometry},
    {"copy", refused, "volumes cannot be copied here"},
    {"volume|body * copy", refused, "volumes cannot be copied here"},
    {"torus|cone|frustum|pyramid|prism", refused, solids},
    {"create torus|cone|frustum|pyramid|prism", refused, solids},
    {"create curve|surface|vertex|volume|body|sheet|spline|mesh|tet|tri|hex|node|edge|face|sideset|nodeset", refused,
     geometry},
    {"create "
     "material|pressure|force|displacement|temperature|convection|heatflux|bcset|constraint|contact|acceleration",
     refused, loads},
    {"material|pressure|force|displacement|temperature|bc|bcset|constraint|contact", refused, loads},
    {"modify", refused, loads},
    {"pillow", refused, "'refine surface ... direction layers 1' puts a layer of hexes along surfaces"},
    {"adapt", refused, "say 'refine hex in field \"error\" top 5 %' and 'coarsen hex in field \"error\" bottom 20 %'"},
    {"refine tri|tet|wedge|pyramid", refused, hexes},
    {"refine mesh", refused, "say 'refine surface ... direction layers', 'direction thickness' or 'refine sheet'"},
    {"refine parallel|boundary", refused,
     "say 'refine surface ... direction layers', 'direction thickness' or 'refine sheet'"},
    {"quality tri|tet|quad|wedge|pyramid", refused, hexes},
    {"block * tri|tet|curve|surface|face|edge|node|vertex|joint", refused,
     "blocks hold hexes: 'block 1 hex in surface 3'"},
    {"transform mesh", refused, "say 'scale 0.001', 'move x 1', 'rotate 90 about z' or 'reflect x', then export"},
    {"python", refused, "Python drives this program from outside: 'import hextwist', Session().cmd(\"...\")"},
};

/// Does this token say one of a|b|c?
bool says(const Token& token, std::string_view alternatives) {
  if (token.kind != Token::Kind::word) return false;
  while (true) {
    const std::size_t end = std::min(alternatives.find('|'), alternatives.size());
    if (same_word(token.text, alternatives.substr(0, end))) return true;
    if (end == alternatives.size()) return false;
    alternatives.remove_prefix(end + 1);
  }
}

/// The words by which it fits; nullopt: it does not.
std::optional<std::string> fits(const Statement& statement, std::string_view pattern) {
  std::size_t at = 0;
  bool anywhere = false;
  std::string said;
  while (!pattern.empty()) {
    const std::size_t end = std::min(pattern.find(' '), pattern.size());
    const std::string_view piece = pattern.substr(0, end);
    pattern.remove_prefix(std::min(end + 1, pattern.size()));
    if (piece == "*") {
      anywhere = true;
      continue;
    }
    while (anywhere && at < statement.tokens.size() && !says(statement.tokens[at], piece)) ++at;
    if (at >= statement.tokens.size() || !says(statement.tokens[at], piece)) return std::nullopt;
    said += (said.empty() ? "" : anywhere ? " ... " : " ") + lower_case(statement.tokens[at].text);
    anywhere = false;
    ++at;
  }
  return said;
}

}  // namespace

std::optional<Foreign> foreign_line(const Statement& statement) {
  for (const Row& row : foreign_words)
    if (std::optional<std::string> said = fits(statement, row.pattern)) {
      if (!row.is_skipped && row.text.empty()) return std::nullopt;
      return Foreign{row.is_skipped, std::move(*said), row.text};
    }
  return std::nullopt;
}

std::optional<Foreign> parse_or_skip(const Statement& statement, Command& command) {
  try {
    command = parse(statement);
    return std::nullopt;
  } catch (const CommandError&) {
    std::optional<Foreign> foreign = foreign_line(statement);
    if (!foreign) throw;
    if (!foreign->is_skipped) throw error_at(statement, statement.tokens.front(), std::string(foreign->text));
    return foreign;
  }
}

std::string skipped_text(const Foreign& foreign) {
  return "'" + foreign.said + "' is skipped" + (foreign.text.empty() ? "" : ": " + std::string(foreign.text));
}

}  // namespace hextwist
