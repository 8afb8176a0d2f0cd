#include "occ_shapes.h"

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GC_MakeSegment.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <array>
#include <cmath>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>
#include <numbers>

namespace hextwist::test {

struct OccShape::Impl {
  TopoDS_Shape shape;
  std::array<TopTools_IndexedMapOfShape, 4> maps;

  explicit Impl(const TopoDS_Shape& s) : shape(s) {
    constexpr std::array kinds{TopAbs_VERTEX, TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID};
    for (std::size_t dim = 0; dim < 4; ++dim) TopExp::MapShapes(shape, kinds[dim], maps[dim]);
  }
};

namespace {

TopoDS_Compound compound(const std::vector<TopoDS_Shape>& shapes) {
  BRep_Builder builder;
  TopoDS_Compound result;
  builder.MakeCompound(result);
  for (const TopoDS_Shape& shape : shapes) builder.Add(result, shape);
  return result;
}

TopoDS_Wire wire(const TopoDS_Edge& edge) {
  return BRepBuilderAPI_MakeWire(edge).Wire();
}

}  // namespace

OccShape OccShape::cylinder(double r, double h) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeCylinder(r, h).Shape()));
}

OccShape OccShape::cylinder_sector(double r, double h, double from, double to) {
  const gp_Ax2 axes(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(std::cos(from), std::sin(from), 0));
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeCylinder(axes, r, h, to - from).Shape()));
}

OccShape OccShape::sphere(double r) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeSphere(r).Shape()));
}

OccShape OccShape::sphere_patch(double r, double from_latitude, double to_latitude, double longitude) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeSphere(r, from_latitude, to_latitude, longitude).Shape()));
}

OccShape OccShape::cone(double r_bottom, double r_top, double h) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeCone(r_bottom, r_top, h).Shape()));
}

OccShape OccShape::torus(double major, double minor) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeTorus(major, minor).Shape()));
}

OccShape OccShape::lemon(double major, double minor) {
  const Handle(Geom_ToroidalSurface) surface =
      new Geom_ToroidalSurface(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), major, minor);
  const double half = std::acos(major / minor);
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  builder.Add(shell, BRepBuilderAPI_MakeFace(surface, 0, 2 * M_PI, M_PI - half, M_PI + half, 1e-7).Face());
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  return OccShape(std::make_shared<Impl>(solid));
}

OccShape OccShape::brick(double x, double y, double z) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeBox(x, y, z).Shape()));
}

OccShape OccShape::brick_with_face_inside(double x, double y, double z, double depth) {
  const gp_Pln plane(gp_Ax3(gp_Pnt(x / 2, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0)));
  TopTools_ListOfShape parts;
  parts.Append(BRepPrimAPI_MakeBox(x, y, z).Shape());
  parts.Append(BRepBuilderAPI_MakeFace(plane, 0, depth, 0, z).Shape());
  BRepAlgoAPI_BuilderAlgo builder;
  builder.SetArguments(parts);
  builder.Build();
  return OccShape(std::make_shared<Impl>(TopExp_Explorer(builder.Shape(), TopAbs_SOLID).Current()));
}

OccShape OccShape::brick_with_vertex(double x, double y, double z, const Vec3& at) {
  const TopoDS_Shape brick = BRepPrimAPI_MakeBox(x, y, z).Shape();
  TopTools_ListOfShape both;
  both.Append(brick);
  both.Append(BRepBuilderAPI_MakeVertex(gp_Pnt(at.x(), at.y(), at.z())).Shape());
  BRepAlgoAPI_BuilderAlgo builder;
  builder.SetArguments(both);
  builder.Build();
  return OccShape(std::make_shared<Impl>(builder.Modified(brick).First()));
}

OccShape OccShape::brick_with_hole(double x, double y, double z, double r) {
  const gp_Ax2 axes(gp_Pnt(x / 2, y / 2, -1), gp_Dir(0, 0, 1));
  const TopoDS_Shape hole = BRepPrimAPI_MakeCylinder(axes, r, z + 2).Shape();
  return OccShape(std::make_shared<Impl>(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(x, y, z).Shape(), hole).Shape()));
}

OccShape OccShape::hollow_ball(double outer, double inner) {
  return OccShape(std::make_shared<Impl>(
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(outer).Shape(), BRepPrimAPI_MakeSphere(inner).Shape()).Shape()));
}

OccShape OccShape::dome(double r) {
  return OccShape(std::make_shared<Impl>(BRepPrimAPI_MakeSphere(r, 0, std::numbers::pi / 2).Shape()));
}

OccShape OccShape::fused_shaft() {
  const gp_Ax2 up(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)),
      down(gp_Pnt(0, 0, 0), gp_Dir(0, 0, -1), gp_Dir(0, 1, 0));
  return OccShape(std::make_shared<Impl>(
      BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(up, 1, 3).Shape(), BRepPrimAPI_MakeCylinder(down, 1.5, 2).Shape())
          .Shape()));
}

OccShape OccShape::loft() {
  BRepOffsetAPI_ThruSections sections(true, false, 1e-6);
  const auto axes = [](double z) { return gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)); };
  sections.AddWire(wire(BRepBuilderAPI_MakeEdge(gp_Circ(axes(0), 4)).Edge()));
  sections.AddWire(wire(BRepBuilderAPI_MakeEdge(gp_Elips(axes(5), 6, 3)).Edge()));
  sections.AddWire(wire(BRepBuilderAPI_MakeEdge(gp_Circ(axes(9), 2.5)).Edge()));
  sections.AddWire(wire(BRepBuilderAPI_MakeEdge(gp_Elips(axes(14), 5, 4)).Edge()));
  sections.Build();
  return OccShape(std::make_shared<Impl>(sections.Shape()));
}

OccShape OccShape::vase() {
  TColgp_Array1OfPnt points(1, 5);
  points.SetValue(1, gp_Pnt(0, 0, 0));
  points.SetValue(2, gp_Pnt(3, 0, 0.5));
  points.SetValue(3, gp_Pnt(4, 0, 4));
  points.SetValue(4, gp_Pnt(2, 0, 7));
  points.SetValue(5, gp_Pnt(3, 0, 10));
  const TopoDS_Edge profile = BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(points).Curve()).Edge();
  const TopoDS_Edge top = BRepBuilderAPI_MakeEdge(gp_Pnt(3, 0, 10), gp_Pnt(0, 0, 10)).Edge();
  const TopoDS_Edge axis = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 10), gp_Pnt(0, 0, 0)).Edge();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(profile, top, axis).Wire()).Face();
  return OccShape(
      std::make_shared<Impl>(BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape()));
}

namespace {

TopoDS_Shape face_of(const std::vector<std::array<double, 2>>& polygon) {
  BRepBuilderAPI_MakePolygon wire;
  for (const auto& [x, y] : polygon) wire.Add(gp_Pnt(x, y, 0));
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire()).Shape();
}
const gp_Ax1 y_axis(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0));
/// All the way round without an angle: what is turned by 2 pi and a little less is not closed.
TopoDS_Shape turn(const TopoDS_Shape& face, double angle) {
  return angle < 6.28 ? BRepPrimAPI_MakeRevol(face, y_axis, angle).Shape()
                      : BRepPrimAPI_MakeRevol(face, y_axis).Shape();
}

}  // namespace

OccShape OccShape::extruded(const std::vector<std::array<double, 2>>& polygon, const Vec3& along) {
  return OccShape(
      std::make_shared<Impl>(BRepPrimAPI_MakePrism(face_of(polygon), gp_Vec(along.x(), along.y(), along.z())).Shape()));
}

OccShape OccShape::turned(const std::vector<std::array<double, 2>>& polygon, double angle) {
  return OccShape(std::make_shared<Impl>(turn(face_of(polygon), angle)));
}

OccShape OccShape::turned_disc(double x, double r, double angle) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(x, 0, 0), gp_Dir(0, 0, 1)), r);
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
  return OccShape(std::make_shared<Impl>(turn(BRepBuilderAPI_MakeFace(wire).Shape(), angle)));
}

OccShape OccShape::together(const std::vector<OccShape>& solids) {
  std::vector<TopoDS_Shape> shapes;
  for (const OccShape& solid : solids) shapes.push_back(solid.impl_->shape);
  return OccShape(std::make_shared<Impl>(compound(shapes)));
}

OccShape OccShape::two_bricks() {
  return OccShape(std::make_shared<Impl>(compound({BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(2, 3, 4)).Shape(),
                                                   BRepPrimAPI_MakeBox(gp_Pnt(2, 0, 0), gp_Pnt(5, 3, 4)).Shape()})));
}

OccShape OccShape::loose_faces_with_cavity() {
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& box : {BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(5, 5, 5)).Shape(),
                                  BRepPrimAPI_MakeBox(gp_Pnt(2, 2, 2), gp_Pnt(3, 3, 3)).Shape()}) {
    for (TopExp_Explorer it(box, TopAbs_FACE); it.More(); it.Next()) {
      faces.push_back(BRepBuilderAPI_Transform(it.Current(), gp_Trsf(), true).Shape());
    }
  }
  return OccShape(std::make_shared<Impl>(compound(faces)));
}

OccShape OccShape::open_shell() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer it(box, TopAbs_FACE); it.More() && faces.size() < 5; it.Next()) faces.push_back(it.Current());
  return OccShape(std::make_shared<Impl>(compound(faces)));
}

OccShape OccShape::loose_faces_that_touch(bool turned) {
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& box : {BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(4, 2, 1)).Shape(),
                                  BRepPrimAPI_MakeBox(gp_Pnt(4, 0, 0), gp_Pnt(8, 2, 1)).Shape()})
    for (TopExp_Explorer it(box, TopAbs_FACE); it.More(); it.Next())
      faces.push_back(BRepBuilderAPI_Transform(it.Current(), gp_Trsf(), true).Shape());
  if (turned) std::ranges::reverse(faces);
  return OccShape(std::make_shared<Impl>(compound(faces)));
}

OccShape OccShape::brep(const std::filesystem::path& file) {
  TopoDS_Shape shape;
  BRepTools::Read(shape, file.c_str(), BRep_Builder());
  return OccShape(std::make_shared<Impl>(shape));
}

OccShape OccShape::as_nurbs() const {
  return OccShape(std::make_shared<Impl>(BRepBuilderAPI_NurbsConvert(impl_->shape, true).Shape()));
}

OccShape OccShape::moved(const Vec3& by, double angle) const {
  gp_Trsf turn, shift;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), angle);
  shift.SetTranslation(gp_Vec(by.x(), by.y(), by.z()));
  return OccShape(std::make_shared<Impl>(impl_->shape.Moved(TopLoc_Location(shift * turn))));
}

OccShape OccShape::reversed() const {
  return OccShape(std::make_shared<Impl>(impl_->shape.Reversed()));
}

CadImport OccShape::import(const CadOptions& options) const {
  return cad_from_shape(impl_->shape, options);
}

void OccShape::write(const std::filesystem::path& file, const std::string& unit) const {
  const Handle(Message_Messenger) messenger = Message::DefaultMessenger();
  const Message_SequenceOfPrinters printers = messenger->Printers();
  messenger->ChangePrinters().Clear();
  const std::string ext = file.extension().string();
  if (ext == ".brep") {
    BRepTools::Write(impl_->shape, file.c_str());
  } else if (ext == ".igs") {
    IGESControl_Controller::Init();
    IGESControl_Writer writer(unit.c_str(), 0);
    writer.AddShape(impl_->shape);
    writer.ComputeModel();
    writer.Write(file.c_str());
  } else {
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", unit.c_str());
    STEPControl_Writer writer;
    writer.Transfer(impl_->shape, STEPControl_AsIs);
    writer.Write(file.c_str());
    Interface_Static::SetCVal("write.step.unit", "MM");
  }
  messenger->ChangePrinters() = printers;
}

double OccShape::distance(Owner entity, const Vec3& p) const {
  const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(p.x(), p.y(), p.z())).Shape();
  return BRepExtrema_DistShapeShape(vertex, impl_->maps[static_cast<std::size_t>(entity.dim)](entity.id)).Value();
}

int OccShape::count(int dim) const {
  return impl_->maps[static_cast<std::size_t>(dim)].Extent();
}

}  // namespace hextwist::test
