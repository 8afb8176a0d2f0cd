// CAD files: what is read, what is said about it, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "geom/occ_shapes.h"
#include "hextwist/geom/renumbered_model.h"
#include "support/analytic_model.h"
#include "support/grids.h"

namespace hextwist {
namespace {

using test::OccShape;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::filesystem::path write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

// The message without the path in front, on one line.
std::string refusal(const std::filesystem::path& file) {
  try {
    read_cad(file);
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos);
    EXPECT_EQ(what.substr(0, file.string().size()), file.string());
    return what.substr(std::min(what.size(), file.string().size() + 2));
  }
  return "accepted";
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

// Sorted measures of a dimension, and the model box: what two files of one shape must agree in.
void expect_same_shape(const Model& a, const Model& b, double accuracy) {
  EXPECT_LT((a.box().min - b.box().min).norm() + (a.box().max - b.box().max).norm(), accuracy);
  for (int dim = 0; dim <= 3; ++dim) {
    ASSERT_EQ(a.count(dim), b.count(dim)) << dimension_name(dim);
    std::vector<double> of_a, of_b;
    for (int id = 1; id <= a.count(dim); ++id) {
      of_a.push_back(a.measure({dim, id}));
      of_b.push_back(b.measure({dim, id}));
    }
    std::sort(of_a.begin(), of_a.end());
    std::sort(of_b.begin(), of_b.end());
    for (std::size_t i = 0; i < of_a.size(); ++i)
      EXPECT_NEAR(of_a[i] / std::max(of_b[i], 1e-3), of_b[i] / std::max(of_b[i], 1e-3), accuracy);
  }
}

TEST(occ_files, step_and_brep_of_real_parts_hold_the_same_shape_once_glued) {
  const auto data = test::data_folder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  for (const std::string name :
       {"bracket_fillet", "cyl_ogrid", "plate_hole", "ring_twist90", "sphere7", "two_material"}) {
    SCOPED_TRACE(name);
    const CadImport brep = read_cad(data / "cad" / (name + ".brep"));
    EXPECT_TRUE(brep.notices.empty());
    CadOptions options;
    options.glue = brep.model->count(3) > 1;
    const CadImport step = read_cad(data / "cad" / (name + ".step"), options);
    EXPECT_EQ(step.notices.size(), options.glue ? 1u : 0u);
    expect_same_shape(*brep.model, *step.model, 1e-7);
    // The same coordinates: each vertex of one is a vertex of the other.
    for (int id = 1; id <= step.model->count(0); ++id) {
      double closest = 1e300;
      for (int other = 1; other <= brep.model->count(0); ++other) {
        closest = std::min(closest, (step.model->point({0, id}, {}) - brep.model->point({0, other}, {})).norm());
      }
      EXPECT_LT(closest, 1e-7);
    }
  }
}

TEST(occ_files, what_is_written_is_read_back_in_every_format) {
  const auto folder = test::output_folder();
  for (const OccShape& shape : {OccShape::brick_with_hole(10, 6, 2, 1.5), OccShape::sphere(3), OccShape::loft()}) {
    const auto model = shape.import().model;
    for (const char* name : {"a.step", "a.STP", "a.brep", "a.iges"}) {
      SCOPED_TRACE(name);
      write_cad(folder / name, *model);
      expect_same_shape(*model, *read_cad(folder / name).model, 1e-6);
      EXPECT_FALSE(std::filesystem::exists(folder / (std::string(name) + ".part")));
    }
  }
}

TEST(occ_files, iges_faces_are_sewed_into_a_solid_with_a_notice) {
  const auto file = test::output_folder() / "plate.igs";
  OccShape::brick_with_hole(10, 6, 2, 1.5).write(file);
  const CadImport part = read_cad(file);
  EXPECT_EQ(part.model->count(3), 1);
  EXPECT_EQ(part.model->count(2), 7);
  ASSERT_EQ(part.notices.size(), 1u);
  EXPECT_EQ(part.notices[0].substr(0, 38), "no solids: sewed 7 faces into 1 solid ");
  EXPECT_NEAR(part.model->measure({3, 1}), 2 * (60 - M_PI * 2.25), 1e-9);
}

TEST(occ_files, the_content_decides_where_there_is_no_extension) {
  const auto folder = test::output_folder();
  for (const char* ext : {".step", ".brep", ".igs"}) {
    OccShape::brick(1, 2, 3).write(folder / (std::string("brick") + ext));
    std::filesystem::copy_file(folder / (std::string("brick") + ext), folder / "brick",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_NEAR(read_cad(folder / "brick").model->measure({3, 1}), 6, 1e-9);
  }
}

TEST(occ_files, lengths_in_other_units_become_millimetres_with_a_notice) {
  const auto folder = test::output_folder();
  OccShape::brick(1, 2, 3).write(folder / "metre.step", "M");
  const CadImport metre = read_cad(folder / "metre.step");
  EXPECT_LT((metre.model->box().max - Vec3(1, 2, 3)).norm(), 1e-9);
  ASSERT_EQ(metre.notices.size(), 1u);
  EXPECT_EQ(metre.notices[0], "lengths converted from metre to millimetre");
  OccShape::brick(1, 2, 3).write(folder / "inch.igs", "INCH");
  const CadImport inch = read_cad(folder / "inch.igs");
  EXPECT_LT((inch.model->box().max - Vec3(1, 2, 3)).norm(), 1e-6);
  EXPECT_EQ(inch.notices.at(0), "lengths converted from INCH to millimetre");
}

TEST(occ_files, names_survive_reading_glueing_and_writing) {
  const auto folder = test::output_folder();
  OccShape::two_bricks().write(folder / "bricks.step");
  std::string text = text_of(folder / "bricks.step");
  const auto name_next = [&](const std::string& entity, const std::string& name) {
    const std::size_t at = text.find(entity + "(''");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, entity.size() + 3, entity + "('" + name + "'");
  };
  name_next("MANIFOLD_SOLID_BREP", "steel");
  name_next("MANIFOLD_SOLID_BREP", "copper");
  name_next("ADVANCED_FACE", "inlet");
  const auto file = write_text(folder / "named.step", text);
  const auto find = [](const Model& model, int dim, const std::string& name) {
    std::vector<int> ids;
    for (int id = 1; id <= model.count(dim); ++id) {
      if (model.name({dim, id}) == name) ids.push_back(id);
    }
    return ids;
  };
  const auto apart = read_cad(file).model;
  EXPECT_EQ(apart->name({3, 1}), "steel");
  EXPECT_EQ(apart->name({3, 2}), "copper");
  ASSERT_EQ(find(*apart, 2, "inlet").size(), 1u);
  const Box inlet = apart->box({2, find(*apart, 2, "inlet")[0]});

  CadOptions glue;
  glue.glue = true;
  const auto glued = read_cad(file, glue).model;
  write_cad(folder / "again.step", *glued);
  for (const auto& model : {glued, read_cad(folder / "again.step").model}) {
    EXPECT_EQ(find(*model, 3, "steel"), std::vector<int>{1});
    EXPECT_EQ(find(*model, 3, "copper"), std::vector<int>{2});
    EXPECT_LT((model->box({3, 1}).max - Vec3(2, 3, 4)).norm(), 1e-9);
    ASSERT_GE(find(*model, 2, "inlet").size(), 1u);
    for (const int id : find(*model, 2, "inlet")) EXPECT_LT((model->box({2, id}).max - inlet.max).norm(), 1e-9);
  }
  EXPECT_EQ(read_cad(folder / "bricks.step").model->name({2, 1}), "") << "no name was given";
}

TEST(occ_files, bad_files_are_refused_in_one_clear_line) {
  const auto folder = test::output_folder();
  EXPECT_EQ(refusal(folder / "none.step"), "no such file");
  EXPECT_EQ(refusal(folder), "not a regular file");
  EXPECT_EQ(refusal(write_text(folder / "empty.step", "")), "the file is empty");
  EXPECT_EQ(refusal(write_text(folder / "empty.brep", " \n")), "the file is empty");
  EXPECT_EQ(refusal(write_text(folder / "prose.step", "This is no STEP file.\n")), "not a STEP file");
  EXPECT_EQ(refusal(write_text(folder / "prose.brep", "This is no BREP file.\n")), "not a BREP file");
  EXPECT_EQ(refusal(write_text(folder / "prose.IGS", "This is no IGES file.\n")), "not an IGES file");
  EXPECT_EQ(refusal(write_text(folder / "prose", "What is this?\n")), "not a STEP, BREP or IGES file");
  EXPECT_EQ(refusal(write_text(folder / "prose.xyz", "What is this?\n")), "not a STEP, BREP or IGES file");

  OccShape::brick(1, 2, 3).reversed().write(folder / "reversed.brep");
  EXPECT_EQ(read_cad(folder / "reversed.brep", {}).model->count(3), 1);
  OccShape::open_shell().write(folder / "open.brep");
  EXPECT_EQ(refusal(folder / "open.brep"),
            "no solid (sewed 5 faces, but they do not close: 4 edges bound one face only)");
  EXPECT_EQ(
      refusal(write_text(folder / "shapeless.step",
                         "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');"
                         "\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\nENDSEC;\n"
                         "END-ISO-10303-21;\n")),
      "the STEP file holds no shape");
}

TEST(occ_files, files_cut_anywhere_or_with_pieces_missing_are_refused) {
  const auto folder = test::output_folder();
  const OccShape shape = OccShape::brick_with_hole(10, 6, 2, 1.5);
  const std::pair<const char*, const char*> formats[] = {{".step", "STEP"}, {".brep", "BREP"}, {".igs", "IGES"}};
  for (const auto& [ext, format] : formats) {
    SCOPED_TRACE(ext);
    shape.write(folder / (std::string("whole") + ext));
    const std::string text = text_of(folder / (std::string("whole") + ext));
    for (int i = 2; i < 40; ++i) {
      const auto file = write_text(folder / (std::string("cut") + ext),
                                   text.substr(0, text.size() * static_cast<std::size_t>(i) / 40));
      EXPECT_EQ(refusal(file), std::string("the ") + format + " file is truncated: its end is missing");
    }
    EXPECT_EQ(refusal(write_text(folder / (std::string("blank") + ext), " \n")), "the file is empty");
  }
  std::string text = text_of(folder / "whole.step");
  const std::size_t middle = text.find("\n#", text.size() / 2) + 1;
  text.erase(middle, text.find("\n#", middle + 2000) + 1 - middle);
  EXPECT_EQ(refusal(write_text(folder / "hole.step", text)).substr(0, 26), "the STEP file is damaged: ");
  text = text_of(folder / "whole.brep");
  const std::size_t shapes = text.find("\nVe\n", text.find("\nTShapes"));
  text.erase(shapes, text.find("\nVe\n", shapes + 1) - shapes);
  EXPECT_EQ(refusal(write_text(folder / "hole.brep", text)).substr(0, 26), "the BREP file is damaged: ");
}

TEST(occ_files, instances_of_a_STEP_file_may_have_any_number_that_fits) {
  const auto folder = test::output_folder();
  OccShape::brick(1, 2, 3).write(folder / "brick.step");
  const std::string text = text_of(folder / "brick.step");
  const auto shifted = [&](long long by) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
      result += text[i];
      if (text[i] != '#' || !std::isdigit(static_cast<unsigned char>(text[i + 1]))) continue;
      std::size_t n_digits = 0;
      result += std::to_string(std::stoll(text.substr(i + 1), &n_digits) + by);
      i += n_digits;
    }
    return write_text(folder / "shifted.step", result);
  };
  EXPECT_EQ(read_cad(shifted(100000000), {}).model->count(2), 6);
  const std::string wrong = refusal(shifted(2147483600));
  EXPECT_EQ(wrong.substr(0, wrong.find("#")),
            "the STEP file has an instance number beyond 2147483647, the last that can be read: ");
}

TEST(occ_files, names_of_volumes_and_surfaces_go_through_IGES) {
  const auto folder = test::output_folder();
  const auto brick = OccShape::brick(1, 2, 3).import().model;
  std::vector<std::pair<Owner, std::string>> names = {{{3, 1}, "body of all"}};
  for (int id = 1; id <= 6; ++id) names.emplace_back(Owner{2, id}, "side " + std::to_string(id));
  const auto named = renamed(brick, names);
  write_cad(folder / "named.iges", *named);
  const auto read = read_cad(folder / "named.iges").model;
  EXPECT_EQ(read->name({3, 1}), "body of all");
  for (int id = 1; id <= 6; ++id) {
    const std::string name = read->name({2, id});
    ASSERT_EQ(name.substr(0, 5), "side ");
    const Box was = named->box({2, std::stoi(name.substr(5))});
    const Box is = read->box({2, id});
    EXPECT_LT((was.min - is.min).norm() + (was.max - is.max).norm(), 1e-6) << name;
  }
}

TEST(occ_files, nothing_is_printed_by_reading_good_or_bad_files) {
  const auto folder = test::output_folder();
  OccShape::brick(1, 2, 3).write(folder / "brick.step");
  OccShape::brick(1, 2, 3).write(folder / "brick.igs");
  std::string text = text_of(folder / "brick.step");
  replace_all(text, "CARTESIAN_POINT", "CARTESIAN_PINT");
  const auto bad = write_text(folder / "bad.step", text);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto model = read_cad(folder / "brick.step").model;
  read_cad(folder / "brick.igs");
  const std::string message = refusal(bad);
  write_cad(folder / "copy.step", *model);
  write_cad(folder / "copy.iges", *model);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(message, "accepted");
}

TEST(occ_files, what_cannot_be_written_is_refused_and_leaves_nothing_behind) {
  const auto folder = test::output_folder();
  const auto model = OccShape::brick(1, 2, 3).import().model;
  const auto refused = [&](const std::filesystem::path& file, const Model& m) -> std::string {
    try {
      write_cad(file, m);
    } catch (const Error& error) {
      return std::string(error.what()).substr(file.string().size());
    }
    return "written";
  };
  for (const char* name : {"a.step", "a.brep", "a.iges"}) {
    EXPECT_EQ(refused(folder / "nowhere" / name, *model),
              ": cannot be written: there is no folder " + (folder / "nowhere").string());
  }
  EXPECT_EQ(refused(folder / "a.stl", *model), ": CAD is written as .step, .brep or .iges");
  EXPECT_EQ(refused(folder / "a.step", *analytic_sphere(1)), ": this model has no CAD shape to write");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.stl"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.step"));
}

}  // namespace
}  // namespace hextwist
