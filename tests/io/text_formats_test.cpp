// LS-DYNA, ANSYS, Nek5000 and SPECFEM3D: there and back, and as parsers of their own see ours.
#include <Eigen/Geometry>
#include <map>
#include <numeric>

#include "hextwist/mesh/second_order/second_order.h"
#include "io/io_support.h"
#include "support/meshed.h"

namespace hextwist {
namespace {

constexpr const char* models[] = {"bracket",      "bracket_fillet", "plate_hole", "plate_quarter",
                                  "cylinder",     "sphere",         "inclusion",  "pipe_tee",
                                  "ring_twist",   "curved_plate",   "cam",        "l_block",
                                  "notched_cube", "bent_bar",       "graded_rod", "bearing_plate"};
constexpr const char* specfem_sides[] = {"free_or_absorbing_surface_file_zmax", "absorbing_surface_file_xmin",
                                         "absorbing_surface_file_xmax",         "absorbing_surface_file_ymin",
                                         "absorbing_surface_file_ymax",         "absorbing_surface_file_bottom"};

TEST(text_formats, groups_names_and_ids_come_back) {
  const auto folder = test::output_folder();
  for (unsigned seed = 1; seed < 6; ++seed)
    for (const std::string name : {"a.k", "a.cdb"}) {
      SCOPED_TRACE(name + " " + std::to_string(seed));
      Mesh mesh = seed < 4 ? test::tidy_mesh(seed, seed % 2) : test::rich_mesh(seed, seed % 2);
      mesh.fields.clear();
      write_mesh(folder / name, mesh, nullptr);
      MeshFile read = read_mesh(folder / name);
      EXPECT_TRUE(test::sets_valid(read.mesh));
      // Sixteen characters have ten digits of the smallest numbers, ANSYS' 21 have 14 of all.
      test::expect_points_near(read.mesh.points, mesh.points, name == "a.k" ? 1e-10 : 1e-13);
      if (seed >= 4 && name == "a.k") {  // hexes in no block are of a part, too
        ASSERT_EQ(read.mesh.blocks.size(), mesh.blocks.size() + 1);
        EXPECT_EQ(read.mesh.blocks.back().id, 71);
        read.mesh.blocks.pop_back();
      }
      mesh.points = read.mesh.points;
      EXPECT_TRUE(test::same_mesh(mesh, read.mesh));
      EXPECT_TRUE(read.notices.empty()) << read.notices[0];
    }
}

TEST(text_formats, all_may_begin_with_a_byte_order_mark) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::tidy_mesh(7, false);
  for (const std::string ending : {"inp", "msh", "mesh", "mfem", "bdf", "unv", "k", "cdb", "vtu", "xdmf"}) {
    SCOPED_TRACE(ending);
    const auto file = folder / ("plain." + ending);
    write_mesh(file, mesh, nullptr);
    const Mesh plain = read_mesh(file).mesh;
    const auto marked = test::write_text(folder / ("marked." + ending), "\xEF\xBB\xBF" + test::text_of(file));
    EXPECT_TRUE(test::same_mesh(plain, read_mesh(marked).mesh));
  }
}

/// Of a mesh that was written: hexes in the same order, nodes at the same places.
void expect_same_hexes(const Mesh& found, const Mesh& expected, double relative) {
  test::expect_points_near(test::corners_of_hexes(found), test::corners_of_hexes(expected), relative);
}

TEST(text_formats, every_shipped_model_comes_back) {
  const auto folder = test::output_folder();
  for (const char* model : models) {
    SCOPED_TRACE(model);
    Mesh mesh = test::shipped(model).mesh;
    for (const std::string name : {"a.k", "a.cdb"}) {
      SCOPED_TRACE(name);
      write_mesh(folder / name, mesh, nullptr);
      const Mesh back = read_mesh(folder / name).mesh;
      test::expect_points_near(back.points, mesh.points, name == "a.k" ? 1e-9 : 1e-13);
      Mesh expected = mesh;
      expected.points = back.points;
      if (mesh.blocks.empty()) expected.blocks = back.blocks;
      EXPECT_TRUE(test::same_mesh(expected, back));
    }
    write_mesh(folder / "a.re2", mesh, nullptr);
    const Mesh nek = read_mesh(folder / "a.re2").mesh;
    EXPECT_EQ(nek.n_nodes(), mesh.n_nodes());
    expect_same_hexes(nek, mesh, 0);
    ASSERT_EQ(nek.blocks.size(), mesh.blocks.size());
    for (std::size_t b = 0; b < nek.blocks.size(); ++b) {
      EXPECT_EQ(nek.blocks[b].id, mesh.blocks[b].id);
      EXPECT_EQ(nek.blocks[b].hexes, mesh.blocks[b].hexes);
    }
    // Sides in several sets are in the first alone.
    std::set<Side> seen;
    std::size_t next = 0;
    const Faces all = faces(mesh);
    for (const SideSet& set : mesh.side_sets) {
      std::vector<Side> own;
      for (const Side& side : set.sides)
        if (all.sides[all.of_hex[side.hex][side.face]][1].hex < 0 && seen.insert(side).second) own.push_back(side);
      if (own.empty()) continue;
      ASSERT_LT(next, nek.side_sets.size());
      EXPECT_EQ(nek.side_sets[next].id, set.id);
      EXPECT_EQ(nek.side_sets[next].sides, own);
      ++next;
    }
    EXPECT_EQ(next, nek.side_sets.size());

    for (std::size_t s = 0; s < mesh.side_sets.size(); ++s)
      if (s < 6) mesh.side_sets[s].name = specfem_sides[s];
    write_mesh(folder / "a.specfem", mesh, nullptr);
    const Mesh specfem = read_mesh(folder / "a.specfem").mesh;
    EXPECT_EQ(specfem.points, mesh.points);
    EXPECT_EQ(specfem.hexes, mesh.hexes);
    if (!mesh.blocks.empty()) {
      EXPECT_EQ(specfem.blocks, mesh.blocks);
    }
    ASSERT_EQ(specfem.side_sets.size(), 6U);  // those that are empty, too
    for (std::size_t s = 0; s < std::min<std::size_t>(6, mesh.side_sets.size()); ++s)
      EXPECT_EQ(specfem.side_sets[s].sides, mesh.side_sets[s].sides);
  }
}

TEST(text_formats, middle_nodes_come_back) {
  const auto folder = test::output_folder();
  for (const char* model : {"bracket", "sphere"}) {
    const MeshedModel meshed = test::shipped(model);
    for (const std::string name : {"a.k", "a.cdb", "a.re2", "a.specfem", "a.mesh"}) {
      SCOPED_TRACE(name + " " + model);
      WriteOptions options;
      options.order = 2;
      options.model = meshed.model.get();
      write_mesh(folder / name, meshed.mesh, &meshed.association, options);
      const MeshFile back = read_mesh(folder / name);
      const int n = name == "a.specfem" || name == "a.mesh" ? 27 : 20;
      const MiddleNodes expected = middle_nodes(second_order(meshed.mesh, meshed.association, meshed.model.get(), n));
      EXPECT_EQ(back.middles.nodes_per_hex, n);
      EXPECT_EQ(back.extras.nodes_per_hex.at(0), n);
      if (name == "a.re2") {  // those of bent edges, by corners that are numbered in another order
        EXPECT_EQ(test::corners_of_hexes(back.mesh), test::corners_of_hexes(meshed.mesh));
        std::set<std::array<double, 9>> found, bent;
        const auto add = [](std::set<std::array<double, 9>>& to, Vec3 a, Vec3 b, const Vec3& m) {
          if (std::pair(b.x(), std::pair(b.y(), b.z())) < std::pair(a.x(), std::pair(a.y(), a.z()))) std::swap(a, b);
          if (m != (a + b) / 2) to.insert({a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), m.x(), m.y(), m.z()});
        };
        const auto all = [&](std::set<std::array<double, 9>>& to, const Mesh& mesh, const MiddleNodes& middles) {
          for (std::size_t e = 0; e < middles.edges.size(); ++e)
            add(to, mesh.points[middles.edges[e][0]], mesh.points[middles.edges[e][1]], middles.edge_points[e]);
        };
        all(found, back.mesh, back.middles), all(bent, meshed.mesh, expected);
        EXPECT_GT(bent.size(), 100U);
        EXPECT_EQ(found, bent);
        continue;
      }
      EXPECT_EQ(back.mesh.hexes, meshed.mesh.hexes);
      ASSERT_EQ(back.middles.edges, expected.edges);
      ASSERT_EQ(back.middles.faces, expected.faces);
      const double exact = name == "a.k" ? 1e-9 : name == "a.cdb" ? 1e-11 : 0;
      for (std::size_t e = 0; e < expected.edges.size(); ++e)
        ASSERT_LE((back.middles.edge_points[e] - expected.edge_points[e]).norm(), exact);
      for (std::size_t f = 0; f < expected.faces.size(); ++f)
        ASSERT_LE((back.middles.face_points[f] - expected.face_points[f]).norm(), exact);
      EXPECT_TRUE(test::sets_valid(back.mesh));
      if (name == "a.specfem") continue;
      ASSERT_EQ(back.mesh.node_sets.size(), meshed.mesh.node_sets.size());
      for (std::size_t s = 0; s < meshed.mesh.node_sets.size(); ++s)
        EXPECT_EQ(back.mesh.node_sets[s].nodes, meshed.mesh.node_sets[s].nodes);
      ASSERT_EQ(back.mesh.side_sets.size(), meshed.mesh.side_sets.size());
      for (std::size_t s = 0; s < meshed.mesh.side_sets.size(); ++s)
        EXPECT_EQ(back.mesh.side_sets[s].sides, meshed.mesh.side_sets[s].sides);
      if (name == "a.mesh") {
        EXPECT_TRUE(test::same_owners(back.tags, meshed.association));
      }
    }
  }
}

// ---- as a parser of its own sees ours ----

/// Volumes of hexes of any order by the same rule.
std::vector<double> volumes_of(const MeshedModel& meshed, int nodes_per_hex) {
  std::vector<double> result(meshed.mesh.hexes.size(), 0);
  if (nodes_per_hex == 8) {
    for (Index h = 0; h < meshed.mesh.n_hexes(); ++h) result[h] = volume(meshed.mesh, h);
    return result;
  }
  const SecondOrder second = second_order(meshed.mesh, meshed.association, meshed.model.get(), nodes_per_hex);
  constexpr std::array<double, 3> at = {0.1127016653792583, 0.5, 0.8872983346207417},
                                  weight = {5. / 18, 8. / 18, 5. / 18};
  for (Index h = 0; h < meshed.mesh.n_hexes(); ++h)
    for (int i = 0; i < 27; ++i) {
      const auto j = jacobian(quadratic_hex(second, h), Vec3(at[i % 3], at[i / 3 % 3], at[i / 9]));
      result[h] += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] * j[0].dot(j[1].cross(j[2]));
    }
  return result;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

TEST(text_formats, a_parser_of_its_own_finds_volumes_and_groups_in_ours) {
  if (std::system("/usr/bin/python3 -c 'import numpy' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3 with numpy";
  const auto folder = test::output_folder();
  struct Written {
    std::filesystem::path file;
    MeshedModel meshed;
    int n;
  };
  std::vector<Written> written;
  std::string command = "/usr/bin/python3 '" HEXTWIST_SOURCE_DIR "/tests/io/formats_judge.py'";
  for (const std::string model : {"bracket", "inclusion"})
    for (const std::string name : {"a.k", "a.cdb", "a.re2", "a.specfem", "a.mesh"})
      for (const int order : {1, 2}) {
        if (name == "a.mesh" && order == 1) continue;  // meshio and Gmsh read that
        MeshedModel meshed = test::shipped(model);
        // Sides of the boundary in one set each, as conditions are.
        std::set<Side> seen;
        for (SideSet& set : meshed.mesh.side_sets) {
          std::erase_if(set.sides, [&](const Side& side) { return !seen.insert(side).second; });
          if (name == "a.specfem" && set.id <= 6) set.name = specfem_sides[set.id - 1];
        }
        if (name == "a.re2" || name == "a.specfem") {
          const Faces all = faces(meshed.mesh);
          for (SideSet& set : meshed.mesh.side_sets)
            std::erase_if(set.sides,
                          [&](const Side& side) { return all.sides[all.of_hex[side.hex][side.face]][1].hex >= 0; });
        }
        WriteOptions options;
        options.order = order;
        options.model = meshed.model.get();
        const auto own = folder / (model + std::to_string(order) + name.substr(2));
        std::filesystem::create_directories(own);
        // MEDIT says owners as well where there are some, and groups by numbers made up for both.
        write_mesh(own / name, meshed.mesh, name == "a.mesh" ? nullptr : &meshed.association, options);
        const int n = order == 1 ? 8 : name == "a.specfem" || name == "a.mesh" ? 27 : 20;
        if (name == "a.mesh") meshed.association = {};
        written.push_back({own / name, meshed, n});
        command += " '" + (own / name).string() + "'";
      }
  const auto out = folder / "out.txt";
  ASSERT_EQ(std::system((command + " > '" + out.string() + "' 2> '" + (folder / "log.txt").string() + "'").c_str()), 0)
      << test::text_of(folder / "log.txt");
  std::istringstream words(test::text_of(out));
  for (const Written& one : written) {
    SCOPED_TRACE(one.file);
    const std::string extension = one.file.extension();
    const Mesh& mesh = one.meshed.mesh;
    std::string word;
    std::int64_t n = 0;
    double found = 0, least = 0;
    int nodes = 0;
    ASSERT_TRUE(words >> word >> n >> found >> least >> nodes);
    EXPECT_EQ(n, mesh.n_hexes());
    EXPECT_EQ(nodes, one.n);
    const std::vector<double> volumes = volumes_of(one.meshed, one.n);
    EXPECT_NEAR(found, std::accumulate(volumes.begin(), volumes.end(), 0.0), 1e-9 * std::abs(found));
    EXPECT_GT(least, 0);
    std::map<std::string, std::pair<std::int64_t, double>> groups;
    while (words >> word && word != "end") {
      std::string name;
      ASSERT_TRUE(words >> name >> n >> found);
      groups[word + " " + name] = {n, found};
    }
    ASSERT_EQ(word, "end");
    const auto expect = [&](const std::string& kind, const std::string& name, int id, std::size_t count,
                            double measure) {
      std::string key = name;
      if (extension == ".re2" || extension == ".mesh" || (extension == ".specfem" && kind == "block"))
        key = std::to_string(id);
      if (extension == ".cdb") key = upper(name);
      const auto group = groups.find(kind + " " + key);
      ASSERT_NE(group, groups.end()) << kind << " " << key;
      EXPECT_EQ(group->second.first, static_cast<std::int64_t>(count)) << key;
      if (kind != "nodeset") {
        EXPECT_NEAR(group->second.second, measure, 1e-9 * measure) << key;
      }
      groups.erase(group);
    };
    for (const Block& block : mesh.blocks) {
      double sum = 0;
      for (const Index h : block.hexes) sum += volumes[h];
      expect("block", block.name, block.id, block.hexes.size(), sum);
    }
    for (const SideSet& set : mesh.side_sets) {
      if (set.sides.empty() || (extension == ".specfem" && set.id > 6)) continue;
      double area = 0;
      for (const Side& side : set.sides) {
        const Quad q = face_node_cycle(mesh.hexes[side.hex], side.face);
        constexpr std::array<double, 3> at = {0.1127016653792583, 0.5, 0.8872983346207417},
                                        weight = {5. / 18, 8. / 18, 5. / 18};
        for (int i = 0; i < 9; ++i) {
          const double u = at[i % 3], v = at[i / 3];
          const Vec3 du = (1 - v) * (mesh.points[q[1]] - mesh.points[q[0]]) +
                          v * (mesh.points[q[2]] - mesh.points[q[3]]),
                     dv = (1 - u) * (mesh.points[q[3]] - mesh.points[q[0]]) +
                          u * (mesh.points[q[2]] - mesh.points[q[1]]);
          area += weight[i % 3] * weight[i / 3] * du.cross(dv).norm();
        }
      }
      expect("sideset", set.name, set.id, set.sides.size(), area);
    }
    for (const auto& [name, group] : groups)
      EXPECT_TRUE(name.starts_with("nodeset")) << name << " is in the file and not in the mesh";
    EXPECT_EQ(groups.size(), extension == ".k" || extension == ".cdb" ? mesh.node_sets.size() : 0);
  }
}

/// Never a crash: a message of one line, or a mesh whose parts fit together.
TEST(text_formats, that_are_cut_short_or_changed_are_refused_or_sound) {
  const auto folder = test::output_folder();
  const Mesh mesh = test::tidy_mesh(5, true);
  std::mt19937 random(7);
  const auto read_or_refuse = [&](const std::filesystem::path& file) {
    try {
      EXPECT_TRUE(test::sets_valid(read_mesh(file).mesh));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  };
  WriteOptions quadratic;
  quadratic.order = 2;
  for (const std::string name : {"a.k", "a.cdb", "a.re2", "b.k", "b.cdb", "b.mesh"}) {
    write_mesh(folder / name, mesh, nullptr, name[0] == 'b' ? quadratic : WriteOptions{});
    const std::string text = test::text_of(folder / name);
    for (int trial = 0; trial < 200; ++trial) {
      SCOPED_TRACE(testing::Message() << name << " " << trial);
      std::string changed = text;
      if (trial % 2 == 0)
        changed.resize(1 + random() % (text.size() - 1));
      else
        for (int k = 0; k < 3; ++k)
          changed[random() % text.size()] =
              name == "a.re2" ? static_cast<char>(random()) : " -+0123456789.,*$\n"[random() % 18];
      read_or_refuse(test::write_text(folder / ("cut_" + name), changed));
    }
  }
  write_mesh(folder / "a.specfem", mesh, nullptr);
  for (const char* name : {"nodes_coords_file", "mesh_file", "materials_file", "nummaterial_velocity_file",
                           "absorbing_surface_file_xmin"}) {
    const std::string text = test::text_of(folder / name);
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(testing::Message() << name << " " << trial);
      std::string changed = text;
      if (trial % 2 == 0)
        changed.resize(random() % text.size());
      else
        for (int k = 0; k < 2; ++k) changed[random() % text.size()] = " -.0123456789\n"[random() % 14];
      test::write_text(folder / name, changed);
      read_or_refuse(folder / "a.specfem");
    }
    test::write_text(folder / name, text);
  }
}

}  // namespace
}  // namespace hextwist
