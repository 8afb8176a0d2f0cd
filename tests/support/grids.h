// Meshes made on the spot for tests.
#pragma once

#include <filesystem>
#include <random>

#include "hextwist/mesh/mesh.h"

namespace hextwist::test {

/// Grid of a x b x c unit cubes; node (i, j, k) has index i + (a + 1) * (j + (b + 1) * k), hexes likewise.
Mesh grid(int a, int b, int c);
/// Grid spacing as given per axis.
Mesh grid(int a, int b, int c, const Vec3& size);

/// The same mesh with nodes and hexes renumbered and each hex turned by a random rotation.
Mesh shuffled(const Mesh& mesh, std::mt19937& random);

/// Irregular: hexes around a vertical line of the given valence (3, 5, ...), `layers` high, each sector n x n.
Mesh pinwheel(int valence, int n, int layers);

/// A closed ring of n >= 3 layers of m x m hexes, whose section has turned by so many quarter turns when it meets
/// itself again. Node (i, j) of layer k has index i + (m + 1) * (j + (m + 1) * k), hexes likewise.
Mesh ring(int m, int n, int quarter_turns);

/// Folder of real CAD and meshes; empty where it does not exist (the test should then GTEST_SKIP()).
std::filesystem::path data_folder();
/// Folder for files that tests write, made anew per test name.
std::filesystem::path output_folder();

}  // namespace hextwist::test
