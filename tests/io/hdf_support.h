// Judges of the formats in HDF5, and of MFEM: tests/io/hdf_judge.py.
#pragma once

#include <Eigen/Geometry>
#include <map>

#include "hextwist/mesh/second_order/second_order.h"
#include "io/io_support.h"

namespace hextwist::test {

/// Was the program built with the library of this extension?
inline bool has_format(const std::string& extension) {
  return (" " + readable_extensions() + " ").find(" " + extension + " ") != std::string::npos &&
         refusal("nowhere" + extension).find("built without") == std::string::npos;
}

inline bool has_judge(const std::string& reader) {
  const std::map<std::string, std::string> modules = {{"vtkhdf", "vtkmodules.vtkIOHDF, numpy"},
                                                      {"vtkcgns", "vtkmodules.vtkIOCGNSReader, numpy"},
                                                      {"h5cgns", "h5py, numpy"},
                                                      {"meshio", "meshio, h5py, numpy"},
                                                      {"mfem", "numpy"}};
  return std::system(("/usr/bin/python3 -c 'import " + modules.at(reader) + "' > /dev/null 2>&1").c_str()) == 0;
}

/// What a reader says of a file.
inline std::multimap<std::string, std::string> judged(const std::string& reader, const std::filesystem::path& file) {
  const auto out = file.parent_path() / "judge.txt", log = file.parent_path() / "judge.log";
  const std::string command = "/usr/bin/python3 '" HEXTWIST_SOURCE_DIR "/tests/io/hdf_judge.py' " + reader + " '" +
                              file.string() + "' > '" + out.string() + "' 2> '" + log.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of(log);
  std::multimap<std::string, std::string> result;
  std::istringstream lines(text_of(out));
  for (std::string line; std::getline(lines, line);) {
    const auto blank = line.find(' ');
    result.emplace(line.substr(0, blank), line.substr(std::min(blank, line.size() - 1) + 1));
  }
  return result;
}
inline bool said(const std::multimap<std::string, std::string>& all, const std::string& key, const std::string& text) {
  const auto [first, last] = all.equal_range(key);
  return std::any_of(first, last, [&](const auto& entry) { return entry.second == text; });
}

/// By Gauss points, which are exact for hexes of 27 nodes.
inline double exact_volume(const SecondOrder& second) {
  double sum = 0;
  for (Index h = 0; h < second.mesh.n_hexes(); ++h)
    for (int i = 0; i < 27; ++i) {
      constexpr std::array<double, 3> at = {0.1127016653792583, 0.5, 0.8872983346207417},
                                      weight = {5. / 18, 8. / 18, 5. / 18};
      const auto j = jacobian(quadratic_hex(second, h), Vec3(at[i % 3], at[i / 3 % 3], at[i / 9]));
      sum += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] * j[0].dot(j[1].cross(j[2]));
    }
  return sum;
}

}  // namespace hextwist::test
