// The shape goes from one process to the other in OpenCASCADE's binary form, which keeps its structure, and with it the
// ids, and every number bit by bit.
#include "hextwist/geom/occ/fenced_cad.h"

#include <BinTools.hxx>
#include <BinTools_FormatVersion.hxx>
#include <Standard_Failure.hxx>
#include <cstdlib>
#include <fstream>

#include "hextwist/base/text.h"
#include "hextwist/geom/occ/model_internal.h"

namespace hextwist::occ {
namespace {

/// Projects a point of every curve and surface back onto it: all that a mesh will ask for has been computed once.
void use(const OccModel& model) {
  for (int dim = 1; dim <= 2; ++dim)
    for (int id = 1; id <= model.count(dim); ++id) {
      const Box box = model.box({dim, id});
      if (!box.empty()) model.Model::project({dim, id}, (box.min + box.max) / 2);
    }
}

CadImport taken(std::istream& in) {
  CadImport result;
  result.notices.resize(take_all<char>(in).size());
  for (std::string& line : result.notices) line = take_text(in);
  Names names;
  for (auto& of_dimension : names) {
    of_dimension.resize(take_all<char>(in).size());
    for (std::string& name : of_dimension) name = take_text(in);
  }
  Known known;
  known.lengths = take_all<double>(in);
  known.integrals = take_all<FaceIntegrals>(in);
  for (auto& boxes : known.boxes) boxes = take_all<Box>(in);
  TopoDS_Shape shape;
  BinTools::Read(shape, in);
  result.model = std::make_shared<OccModel>(shape, std::move(names), &known);
  return result;
}

}  // namespace

CadImport read_cad_fenced(const std::filesystem::path& file, const CadOptions& options) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) throw Error(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file, code)) throw Error(file.string() + ": not a regular file");
  const Handover handover;
  read_fenced(options.fence, fenced_cad, file, {options.glue ? "glue" : "", short_number(options.glue_tolerance, 17)},
              handover);
  std::ifstream in(handover.path(), std::ios::binary);
  try {
    return taken(in);
  } catch (const Standard_Failure& failure) {
    throw Error(file.string() + ": OpenCASCADE failed: " + failure.GetMessageString());
  } catch (const Error& error) {
    throw Error(file.string() + ": " + error.what());
  }
}

void serve_cad(const FencedJob& job) {
  CadOptions options;
  options.glue = !job.words.empty() && job.words[0] == "glue";
  if (job.words.size() > 1) options.glue_tolerance = std::strtod(job.words[1].c_str(), nullptr);
  const CadImport read = read_cad(job.file, options);
  const auto& model = dynamic_cast<const OccModel&>(*read.model);
  Known known;
  try {
    known = model.known();
    use(model);
  } catch (const Error& error) {
    throw Error(job.file.string() + ": " + error.what());
  }
  std::ofstream out(job.to, std::ios::binary);
  put_all(out, std::vector<char>(read.notices.size()));
  for (const std::string& line : read.notices) put(out, line);
  for (const auto& of_dimension : model.names()) {
    put_all(out, std::vector<char>(of_dimension.size()));
    for (const std::string& name : of_dimension) put(out, name);
  }
  put_all(out, known.lengths);
  put_all(out, known.integrals);
  for (const auto& boxes : known.boxes) put_all(out, boxes);
  BinTools::Write(model.shape(), out, true, true, BinTools_FormatVersion_CURRENT);
  out.close();
  if (!out) throw std::bad_alloc();
}

}  // namespace hextwist::occ
