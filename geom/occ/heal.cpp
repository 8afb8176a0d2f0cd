#include "hextwist/geom/occ/heal_internal.h"

#include <BOPAlgo_Builder.hxx>
#include <BOPAlgo_MakerVolume.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_FixSmallFace.hxx>
#include <ShapeFix_Wireframe.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <array>
#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/base/types.h"

namespace hextwist::occ {
namespace {

int count_kind(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map.Extent();
}

/// Of the solids: what is beside them has none.
double volume_of(const TopoDS_Shape& shape) {
  double sum = 0;
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(solids.Current(), properties);
    sum += std::abs(properties.Mass());
  }
  return sum;
}

double size_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

TopoDS_Solid solid_from(const TopoDS_Shape& shell) {
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

bool inside(const TopoDS_Shape& shell, const TopoDS_Solid& solid) {
  const TopExp_Explorer vertex(shell, TopAbs_VERTEX);
  if (!vertex.More()) return false;
  BRepClass3d_SolidClassifier classifier(solid, BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())), 1e-9);
  return classifier.State() == TopAbs_IN;
}

void rename(ShapeNames& names, const TopoDS_Shape& from, const TopoDS_Shape& to) {
  const auto found = names.find(from.TShape().get());
  if (found != names.end()) names.emplace(to.TShape().get(), std::string(found->second));
}

/// Names of all shapes of a kind go on to their images.
template <class ImagesOf>
void rename_all(Part& part, TopAbs_ShapeEnum kind, const ImagesOf& images_of) {
  TopTools_IndexedMapOfShape shapes;
  TopExp::MapShapes(part.shape, kind, shapes);
  for (int i = 1; i <= shapes.Extent(); ++i)
    for (const TopoDS_Shape& image : images_of(shapes(i))) rename(part.names, shapes(i), image);
}

/// Edges by the number of faces at them, of which one at a seam has its own twice.
struct FacesAtEdges {
  int n_free = 0;       ///< edges of one face only
  int n_branching = 0;  ///< of more than two
};
FacesAtEdges faces_at_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  FacesAtEdges count;
  for (int i = 1; i <= faces_of_edge.Extent(); ++i) {
    if (BRep_Tool::Degenerated(TopoDS::Edge(faces_of_edge.FindKey(i)))) continue;
    count.n_free += faces_of_edge(i).Extent() == 1;
    count.n_branching += faces_of_edge(i).Extent() > 2;
  }
  return count;
}

/// Sewn faces of solids that touch: every region that they enclose is a solid. How many there are; with none the part
/// stays as it is.
int make_touching_solids(Part& part, const TopoDS_Shape& sewed) {
  BOPAlgo_MakerVolume maker;
  maker.SetNonDestructive(true);
  maker.SetRunParallel(false);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(sewed, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) maker.AddArgument(faces(i));
  maker.SetIntersect(true);
  maker.Perform();
  if (maker.HasErrors()) return 0;
  const int n_solids = count_solids(maker.Shape());
  if (n_solids == 0) return 0;
  for (int i = 1; i <= faces.Extent(); ++i)
    for (const TopoDS_Shape& to : maker.Modified(faces(i))) rename(part.names, faces(i), to);
  part.shape = maker.Shape();
  return n_solids;
}

}  // namespace

int count_solids(const TopoDS_Shape& shape) {
  return count_kind(shape, TopAbs_SOLID);
}

void make_solids(Part& part) {
  const int n_faces = count_kind(part.shape, TopAbs_FACE);
  if (n_faces == 0) return;
  const double tolerance = std::max(1e-6, 1e-6 * size_of(part.shape));
  BRepBuilderAPI_Sewing sewing(tolerance);
  sewing.SetNonManifoldMode(true);  // else faces of solids that touch are paired as they come
  sewing.Add(part.shape);
  sewing.Perform();
  const TopoDS_Shape sewed = sewing.SewedShape();
  if (sewed.IsNull()) return;
  for (TopExp_Explorer faces(part.shape, TopAbs_FACE); faces.More(); faces.Next()) {
    if (sewing.IsModified(faces.Current())) rename(part.names, faces.Current(), sewing.Modified(faces.Current()));
  }
  const FacesAtEdges at_edges = faces_at_edges(sewed);
  if (at_edges.n_branching > 0) {
    if (const int n_solids = make_touching_solids(part, sewed)) {
      part.notices.push_back("no solids: sewed " + std::to_string(n_faces) + " faces into " +
                             counted(n_solids, "solid") + ", which touch (tolerance " + short_number(tolerance, 3) +
                             ")");
      return;
    }
  }
  std::vector<TopoDS_Solid> solids;
  for (TopExp_Explorer shells(sewed, TopAbs_SHELL); shells.More(); shells.Next()) {
    if (BRep_Tool::IsClosed(shells.Current())) solids.push_back(solid_from(shells.Current()));
  }
  if (sewed.ShapeType() == TopAbs_FACE) {  // of one face: a sphere, a torus
    TopoDS_Shell shell;
    BRep_Builder().MakeShell(shell);
    BRep_Builder().Add(shell, sewed);
    if (BRep_Tool::IsClosed(shell)) solids.push_back(solid_from(shell));
  }
  if (solids.empty()) {
    part.notices.push_back("sewed " + std::to_string(n_faces) + " faces, but they do not close: " +
                           std::to_string(at_edges.n_free) + " edges bound one face only");
    return;
  }
  // A shell inside an odd number of others is a cavity of the innermost of them.
  const std::size_t n = solids.size();
  std::vector<std::vector<std::size_t>> around(n);
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (i != j && inside(solids[i], solids[j])) around[i].push_back(j);
    }
  }
  BRep_Builder builder;
  TopoDS_Compound result;
  builder.MakeCompound(result);
  int n_solids = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (around[i].size() % 2 == 1) continue;
    TopoDS_Solid solid = solids[i];
    for (std::size_t j = 0; j < n; ++j) {
      if (around[j].size() != around[i].size() + 1 || !inside(solids[j], solids[i])) continue;
      const TopExp_Explorer shell(solids[j], TopAbs_SHELL);
      builder.Add(solid, shell.Current().Reversed());
    }
    builder.Add(result, solid);
    ++n_solids;
  }
  if (n_solids == 1) {
    part.shape = TopExp_Explorer(result, TopAbs_SOLID).Current();
  } else {
    part.shape = result;
  }
  part.notices.push_back("no solids: sewed " + std::to_string(n_faces) + " faces into " + counted(n_solids, "solid") +
                         " (tolerance " + short_number(tolerance, 3) + ")");
}

void glue_solids(Part& part, double tolerance) {
  TopTools_IndexedMapOfShape solids;
  TopExp::MapShapes(part.shape, TopAbs_SOLID, solids);
  if (solids.Extent() < 2) {
    part.notices.push_back("nothing to glue: the model has one solid");
    return;
  }
  constexpr std::array kinds{TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX};
  const std::array words{" faces", " edges", " vertices"};

  BOPAlgo_Builder fuse;
  fuse.SetNonDestructive(true);
  fuse.SetRunParallel(false);
  if (tolerance > 0) fuse.SetFuzzyValue(tolerance);
  for (int i = 1; i <= solids.Extent(); ++i) fuse.AddArgument(solids(i));
  fuse.Perform();
  if (fuse.HasErrors()) throw Error("the solids could not be glued: OpenCASCADE's general fuse failed");

  BRep_Builder builder;
  TopoDS_Compound result;
  builder.MakeCompound(result);
  TopTools_IndexedMapOfShape taken;
  std::string split;
  for (int i = 1; i <= solids.Extent(); ++i) {
    TopTools_ListOfShape pieces = fuse.Modified(solids(i));
    if (pieces.IsEmpty()) pieces.Append(solids(i));
    if (pieces.Extent() > 1 && split.empty()) {
      split = "solid " + std::to_string(i) + " overlaps another and was cut into " + std::to_string(pieces.Extent()) +
              " pieces";
    }
    for (const TopoDS_Shape& piece : pieces) {
      rename(part.names, solids(i), piece);
      if (taken.Contains(piece)) continue;
      taken.Add(piece);
      builder.Add(result, piece);
    }
  }
  const double before = volume_of(part.shape), after = volume_of(result);
  // Faces may be cut as well: how many there are does not tell whether any is shared.
  int n_uses = 0;
  for (TopExp_Explorer it(result, TopAbs_SOLID); it.More(); it.Next()) n_uses += count_kind(it.Current(), TopAbs_FACE);
  const bool any_shared = n_uses > count_kind(result, TopAbs_FACE);
  // What bounds no solid (datum planes, lines to refine along) stays beside them as it is.
  for (TopExp_Explorer it(part.shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next())
    builder.Add(result, it.Current());
  for (TopExp_Explorer it(part.shape, TopAbs_EDGE, TopAbs_FACE); it.More(); it.Next())
    builder.Add(result, it.Current());
  for (const TopAbs_ShapeEnum kind : kinds)
    rename_all(part, kind, [&](const TopoDS_Shape& piece) { return fuse.Modified(piece); });
  std::string notice = "glued " + std::to_string(solids.Extent()) + " solids:";
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    notice += (k ? ", " : " ") + std::to_string(count_kind(part.shape, kinds[k])) + " -> " +
              std::to_string(count_kind(result, kinds[k])) + words[k];
  }
  if (!any_shared) notice += "; no two solids share a face";
  part.shape = result;
  part.notices.push_back(notice);
  if (!split.empty()) part.notices.push_back(split);
  if (std::abs(before - after) > 1e-6 * before) {
    part.notices.push_back("gluing changed the volume from " + short_number(before, 3) + " to " +
                           short_number(after, 3));
  }
}

void merge_slivers(Part& part, double length) {
  const Handle(ShapeBuild_ReShape) changes = new ShapeBuild_ReShape;
  const auto prepare = [&](ShapeFix_Root& fix) {
    fix.SetContext(changes);
    fix.SetPrecision(length);
    fix.SetMaxTolerance(length);
  };
  const Handle(ShapeFix_FixSmallFace) faces = new ShapeFix_FixSmallFace;
  prepare(*faces);
  faces->Init(part.shape);
  faces->Perform();
  const Handle(ShapeFix_Wireframe) edges = new ShapeFix_Wireframe(faces->FixShape());
  prepare(*edges);
  edges->ModeDropSmallEdges() = true;
  edges->FixSmallEdges();
  edges->FixWireGaps();
  const TopoDS_Shape result = edges->Shape();
  const int n_edges = count_kind(part.shape, TopAbs_EDGE), n_now = count_kind(result, TopAbs_EDGE);
  const double before = volume_of(part.shape), after = volume_of(result);
  if (n_now >= n_edges || count_solids(result) != count_solids(part.shape) || !BRepCheck_Analyzer(result).IsValid() ||
      std::abs(before - after) > length * size_of(part.shape) * size_of(part.shape))
    return;
  for (const TopAbs_ShapeEnum kind : {TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX})
    rename_all(part, kind, [&](const TopoDS_Shape& old) {
      TopTools_ListOfShape images;
      if (const TopoDS_Shape now = changes->Apply(old); !now.IsNull() && now.ShapeType() == kind) images.Append(now);
      return images;
    });
  const int n_faces = count_kind(part.shape, TopAbs_FACE) - count_kind(result, TopAbs_FACE);
  part.notices.push_back(counted(n_edges - n_now, "edge") + (n_faces > 0 ? " and " + counted(n_faces, "face") : "") +
                         " of the CAD that are at most " + short_number(length) +
                         (n_faces > 0 ? " long or wide" : " long") + " are merged into those beside them");
  part.shape = result;
}

}  // namespace hextwist::occ
