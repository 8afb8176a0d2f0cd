// CAD files through OpenCASCADE. Its readers share global settings and a global messenger, so one file is read or
// written at a time, and its chatter is kept from the terminal.
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESBasic_Name.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESControl_Writer.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <TransferBRep_ShapeMapper.hxx>
#include <Transfer_FinderProcess.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>

#include "hextwist/base/replacement.h"
#include "hextwist/base/text.h"
#include "hextwist/geom/occ/cad_text_internal.h"
#include "hextwist/geom/occ/fenced_cad.h"
#include "hextwist/geom/occ/heal_internal.h"
#include "hextwist/geom/occ/model.h"
#include "hextwist/geom/occ/model_internal.h"
#include "hextwist/geom/renumbered_model.h"

namespace hextwist {
namespace {

using occ::OccModel;
using occ::Part;

std::mutex& occ_files() {
  static std::mutex mutex;
  return mutex;
}

// No printers while it lives.
class Silence {
 public:
  Silence() : messenger_(Message::DefaultMessenger()), printers_(messenger_->Printers()) {
    messenger_->ChangePrinters().Clear();
  }
  ~Silence() { messenger_->ChangePrinters() = printers_; }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  Handle(Message_Messenger) messenger_;
  Message_SequenceOfPrinters printers_;
};

CadFormat format_by_extension(const std::filesystem::path& file) {
  const std::string ext = lower_extension(file);
  if (ext == ".step" || ext == ".stp") return CadFormat::step;
  if (ext == ".brep" || ext == ".brp") return CadFormat::brep;
  if (ext == ".iges" || ext == ".igs") return CadFormat::iges;
  return CadFormat::unknown;
}

std::string contents(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) throw Error(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file, code)) throw Error(file.string() + ": not a regular file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be opened");
  // Not by a stream of text, which would take a lack of memory for the end of the file.
  std::string result(std::filesystem::file_size(file, code), '\0');
  in.read(result.data(), static_cast<std::streamsize>(result.size()));
  if (code || in.bad()) throw Error(file.string() + ": cannot be read");
  result.resize(static_cast<std::size_t>(in.gcount()));
  if (result.find_first_not_of(" \t\r\n") == std::string::npos) throw Error(file.string() + ": the file is empty");
  return result;
}

std::string to_string(const Handle(TCollection_HAsciiString) & s) {
  return s.IsNull() ? "" : s->ToCString();
}

// Names that writers put in when there is none.
bool meaningful(const std::string& name) {
  return !name.empty() && name != "NONE" && name.rfind("Open CASCADE", 0) != 0 &&
         name.find_first_not_of(' ') != std::string::npos;
}

void collect_names(const STEPControl_Reader& reader, occ::ShapeNames& names) {
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  // Items (faces, solids, ...) first; a product names its only solid where that has no name of its own.
  for (const bool products : {false, true}) {
    for (int i = 1; i <= process->NbMapped(); ++i) {
      const Handle(Standard_Transient) entity = process->Mapped(i);
      std::string name;
      if (products) {
        const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(entity);
        if (!definition.IsNull() && !definition->Formation().IsNull() &&
            !definition->Formation()->OfProduct().IsNull()) {
          name = to_string(definition->Formation()->OfProduct()->Name());
          if (!meaningful(name)) name = to_string(definition->Formation()->OfProduct()->Id());
        }
      } else if (const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity)) {
        name = to_string(item->Name());
      }
      if (!meaningful(name)) continue;
      TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
      if (shape.IsNull()) continue;
      if (products) {
        if (occ::count_solids(shape) != 1) continue;
        shape = TopExp_Explorer(shape, TopAbs_SOLID).Current();
      } else if (shape.ShapeType() == TopAbs_COMPOUND && occ::count_solids(shape) == 1) {
        shape = TopExp_Explorer(shape, TopAbs_SOLID).Current();
      }
      names.emplace(shape.TShape().get(), name);
    }
  }
}

// Names of IGES are properties of entities, or labels of eight letters.
void collect_names(const IGESControl_Reader& reader, const IGESData_IGESModel& model, occ::ShapeNames& names) {
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = model.Entity(i);
    if (entity.IsNull() || !entity->HasName()) continue;
    std::string name = to_string(entity->NameValue());
    if (!meaningful(name)) continue;
    name.erase(name.find_last_not_of(' ') + 1);
    name.erase(0, name.find_first_not_of(' '));  // labels end at the right
    TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (shape.IsNull()) continue;
    if (shape.ShapeType() < TopAbs_SOLID) {
      if (occ::count_solids(shape) != 1) continue;
      shape = TopExp_Explorer(shape, TopAbs_SOLID).Current();
    }
    names.emplace(shape.TShape().get(), name);
  }
}

// OpenCASCADE goes on with entities that it could not read and may crash on them.
void refuse_unreadable_geometry(const STEPControl_Reader& reader, const std::filesystem::path& file) {
  Interface_CheckIterator checks = reader.WS()->ModelCheckList(true);
  for (checks.Start(); checks.More(); checks.Next()) {
    const Handle(Interface_Check) check = checks.Value();
    if (!check->HasFailed() || check->Entity().IsNull()) continue;
    const std::string kind = check->Entity()->DynamicType()->Name();
    if (kind.rfind("StepGeom_", 0) != 0 && kind.rfind("StepShape_", 0) != 0) continue;
    throw Error(file.string() + ": the STEP file is damaged: #" +
                std::to_string(reader.StepModel()->IdentLabel(check->Entity())) + " cannot be read (" +
                check->CFail(1) + ")");
  }
}

Part read_step(const std::filesystem::path& file) {
  Part part;
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  STEPControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw Error(file.string() + ": not a valid STEP file");
  refuse_unreadable_geometry(reader, file);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (!lengths.IsEmpty()) {
    const std::string unit = lower_case(lengths.First().ToCString());
    if (unit != "millimetre" && unit != "millimeter" && unit != "mm") {
      part.notices.push_back("lengths converted from " + unit + " to millimetre");
    }
  }
  reader.TransferRoots();
  if (reader.NbShapes() == 0) throw Error(file.string() + ": the STEP file holds no shape");
  part.shape = reader.OneShape();
  collect_names(reader, part.names);
  return part;
}

Part read_iges(const std::filesystem::path& file) {
  Part part;
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw Error(file.string() + ": not a valid IGES file");
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (!model.IsNull()) {
    const std::string unit = to_string(model->GlobalSection().UnitName());
    if (!unit.empty() && unit != "MM") part.notices.push_back("lengths converted from " + unit + " to millimetre");
  }
  reader.TransferRoots();
  if (reader.NbShapes() == 0) throw Error(file.string() + ": the IGES file holds no shape");
  part.shape = reader.OneShape();
  if (!model.IsNull()) collect_names(reader, *model, part.names);
  return part;
}

Part read_brep(const std::filesystem::path& file, const std::string& text) {
  Part part;
  // OpenCASCADE reads on and on where a number is none.
  std::istringstream in(text + "\n");
  in.exceptions(std::ios::failbit | std::ios::badbit);
  BRep_Builder builder;
  try {
    BRepTools::Read(part.shape, in, builder);
  } catch (const std::ios::failure&) {
    throw Error(file.string() + ": the BREP file is damaged: a number or a word is missing or wrong");
  }
  if (part.shape.IsNull()) throw Error(file.string() + ": not a valid BREP file");
  return part;
}

CadImport finish(Part part, const CadOptions& options, const std::string& what) try {
  if (part.shape.IsNull()) throw Error(what + ": no shape");
  if (occ::count_solids(part.shape) == 0) occ::make_solids(part);
  if (occ::count_solids(part.shape) == 0) {
    throw Error(what + ": no solid" + (part.notices.empty() ? "" : " (" + part.notices.back() + ")"));
  }
  if (options.glue) occ::glue_solids(part, options.glue_tolerance);
  const occ::ShapeMaps maps = occ::entity_maps(part.shape);
  occ::Names names;
  for (std::size_t dim = 0; dim <= 3 && !part.names.empty(); ++dim) {
    names[dim].resize(static_cast<std::size_t>(maps[dim].Extent()) + 1);
    for (int id = 1; id <= maps[dim].Extent(); ++id) {
      const auto found = part.names.find(maps[dim](id).TShape().get());
      if (found != part.names.end()) names[dim][static_cast<std::size_t>(id)] = found->second;
    }
  }
  return {std::make_shared<OccModel>(part.shape, std::move(names)), std::move(part.notices)};
} catch (const Error& error) {
  if (std::string_view(error.what()).starts_with(what + ":")) throw;
  throw Error(what + ": " + error.what());
}

// OpenCASCADE's exceptions as ours.
template <class Function>
auto guarded(const std::string& what, const Function& function) {
  try {
    return function();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const std::string message = failure.GetMessageString() ? failure.GetMessageString() : "";
    throw Error(what + ": OpenCASCADE failed" + (message.empty() ? "" : ": " + message));
  }
}

}  // namespace

CadImport read_cad(const std::filesystem::path& file, const CadOptions& options) {
  if (options.fence.is_there()) return occ::read_cad_fenced(file, options);
  const std::string text = contents(file);
  CadFormat format = format_by_extension(file);
  const CadFormat content = format_by_content(text);
  if (format == CadFormat::unknown) format = content;
  if (format == CadFormat::unknown) throw Error(file.string() + ": not a STEP, BREP or IGES file");
  if (content != format)
    throw Error(file.string() + ": not " + (format == CadFormat::iges ? "an " : "a ") + format_name(format) + " file");
  if (const std::string defect = text_defect(format, text); !defect.empty()) throw Error(file.string() + ": " + defect);
  return guarded(file.string(), [&] {
    const std::lock_guard lock(occ_files());
    const Silence silence;
    Part part = format == CadFormat::step   ? read_step(file)
                : format == CadFormat::iges ? read_iges(file)
                                            : read_brep(file, text);
    return finish(std::move(part), options, file.string());
  });
}

CadImport cad_from_shape(const TopoDS_Shape& shape, const CadOptions& options) {
  return guarded("shape", [&] {
    const std::lock_guard lock(occ_files());
    const Silence silence;
    Part part;
    part.shape = shape;
    return finish(std::move(part), options, "shape");
  });
}

namespace {

/// The model of a shape behind one under other names, and the names by its own ids.
const OccModel* shape_behind(const Model& model, occ::Names& names) {
  const auto of = renumbering_of(model);
  const auto* result = of ? shape_behind(*of->model, names) : dynamic_cast<const OccModel*>(&model);
  if (!result) return nullptr;
  if (!of) names = result->names();
  for (int dim = 0; dim <= 3 && of; ++dim) {
    const auto& given = of->renumbering.name[dim];
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (given[i].empty()) continue;
      names[dim].resize(std::max(names[dim].size(), i + 2));
      names[dim][i + 1] = given[i];
    }
  }
  return result;
}

/// The model of the shape behind this one after `change`, with its names.
CadImport changed(const Model& model, const std::string& task, const std::function<void(Part&)>& change) {
  occ::Names names;
  const OccModel* const occ_model = shape_behind(model, names);
  if (!occ_model) throw Error("this model has no CAD shape to " + task);
  return guarded("shape", [&] {
    const std::lock_guard lock(occ_files());
    const Silence silence;
    Part part;
    part.shape = occ_model->shape();
    const occ::ShapeMaps maps = occ::entity_maps(part.shape);
    for (std::size_t dim = 0; dim <= 3; ++dim)
      for (std::size_t id = 1; id < names[dim].size(); ++id)
        if (const std::string& name = names[dim][id]; !name.empty())
          part.names.emplace(maps[dim](static_cast<int>(id)).TShape().get(), name);
    change(part);
    return finish(std::move(part), {}, "shape");
  });
}

}  // namespace

CadImport glued(const Model& model, double tolerance) {
  return changed(model, "glue", [&](Part& part) { occ::glue_solids(part, tolerance); });
}

CadImport without_slivers(const Model& model, double length) {
  return changed(model, "mend", [&](Part& part) { occ::merge_slivers(part, length); });
}

namespace {

bool write_step(const std::filesystem::path& file, const OccModel& model, const occ::Names& names) {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("write.step.unit", "MM");
  STEPControl_Writer writer;
  if (writer.Transfer(model.shape(), STEPControl_AsIs) != IFSelect_RetDone) return false;
  const Handle(Transfer_FinderProcess) process = writer.WS()->TransferWriter()->FinderProcess();
  const occ::ShapeMaps maps = occ::entity_maps(model.shape());
  for (std::size_t dim = 0; dim <= 3; ++dim) {
    for (std::size_t id = 1; id < names[dim].size(); ++id) {
      const std::string& name = names[dim][id];
      if (name.empty()) continue;
      const auto item = STEPConstruct::FindEntity(process, maps[dim](static_cast<int>(id)));
      if (!item.IsNull()) item->SetName(new TCollection_HAsciiString(name.c_str()));
    }
  }
  return writer.Write(file.c_str()) == IFSelect_RetDone;
}

bool write_iges(const std::filesystem::path& file, const OccModel& model, const occ::Names& names) {
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Writer writer("MM", 1);
  if (!writer.AddShape(model.shape())) return false;
  const occ::ShapeMaps maps = occ::entity_maps(model.shape());
  for (std::size_t dim = 0; dim <= 3; ++dim)
    for (std::size_t id = 1; id < names[dim].size(); ++id) {
      if (names[dim][id].empty()) continue;
      Handle(IGESData_IGESEntity) entity;
      const auto mapper = TransferBRep::ShapeMapper(writer.TransferProcess(), maps[dim](static_cast<int>(id)));
      if (!writer.TransferProcess()->FindTypedTransient(mapper, STANDARD_TYPE(IGESData_IGESEntity), entity)) continue;
      const Handle(IGESBasic_Name) property = new IGESBasic_Name();
      property->Init(1, new TCollection_HAsciiString(names[dim][id].c_str()));
      entity->AddProperty(property);
      writer.Model()->AddEntity(property);
    }
  writer.ComputeModel();
  return writer.Write(file.c_str());
}

}  // namespace

void write_cad(const std::filesystem::path& file, const Model& model) {
  occ::Names names;
  const OccModel* const occ_model = shape_behind(model, names);
  if (!occ_model) throw Error(file.string() + ": this model has no CAD shape to write");
  const CadFormat format = format_by_extension(file);
  if (format == CadFormat::unknown) throw Error(file.string() + ": CAD is written as .step, .brep or .iges");
  Replacement replacement(file, true);
  const std::filesystem::path& temporary = replacement.temporary();
  const bool written = guarded(file.string(), [&] {
    const std::lock_guard lock(occ_files());
    const Silence silence;
    if (format == CadFormat::step) return write_step(temporary, *occ_model, names);
    if (format == CadFormat::iges) return write_iges(temporary, *occ_model, names);
    std::ofstream out(temporary);
    BRepTools::Write(occ_model->shape(), out);
    out.close();
    return !out.fail();
  });
  if (!written) replacement.fail("cannot be written");
  replacement.commit();
}

}  // namespace hextwist
