// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/label_mesh.hpp>
#include <plica/meshes/label_votes.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/repair_mesh.hpp>

#include "support/refusal.hpp"

// Tetrahedra of images of labels: they fit together, have the volume of the labels and no slivers.
namespace {

using namespace plica;
using plica::test::refusal;

// A ball of radius 10 with the label 1, of which the part beyond x = 2.5 has the label 7. Voxels
// are 0.5 x 0.5 x 1, along axes that are turned
LabelImage ball_of_two() {
  LabelImage image;
  image.size = {50, 50, 25};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.3, Point(1, 2, 3).normalized()).toRotationMatrix();
  image.axes = turn * Point(0.5, 0.5, 1).asDiagonal();
  image.origin = image.axes * Point(-24.5, -24.5, -12);
  for (int k = 0; k < 25; ++k)
    for (int j = 0; j < 50; ++j)
      for (int i = 0; i < 50; ++i) {
        const Point x = image.origin + image.axes * Point(i, j, k);
        image.labels.push_back(x.norm() > 10 ? 0 : x[0] > 2.5 ? 7 : 1);
      }
  return image;
}

TEST(LabelVotes, SeeAPlaneWhereVoxelsMakeSteps) {
  LabelImage image;
  image.size = {40, 40, 40};
  image.origin = Point(-20, -20, -20);
  const Point normal = Point(1, 2, 3).normalized();
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i)
        image.labels.push_back(normal.dot(image.origin + Point(i, j, k)) > 0.3 ? 2 : 1);
  const LabelVotes votes(image, 3);
  for (const double offset : {-1.5, -0.5, 0.0, 1.0, 2.0}) {
    const Point x = (0.3 + offset) * normal + 2 * Point(3, 0, -1).normalized();
    const auto place = votes.beside(x, {0, 1, 2});
    ASSERT_TRUE(place.has_value());
    EXPECT_NE(place->inside, 0);
    const double above = place->inside == 2 ? place->distance : -place->distance;
    EXPECT_NEAR(above, offset, 0.35);
    EXPECT_GT(std::abs(place->normal.dot(normal)), 0.95);
    EXPECT_EQ(votes.most(x), offset > 0 ? 2 : offset < 0 ? 1 : votes.most(x));
    EXPECT_EQ(votes.margin(x, 2, 1), -votes.margin(x, 1, 2));
    EXPECT_FALSE(votes.beside(x, {0, 1}).has_value()) << "no 0 is near";
  }
  EXPECT_EQ(votes.at(Point(-20.6, 0, 0)), 0) << "beyond the image";
  EXPECT_EQ(votes.at(Point(-20.4, -19, -19)), 1);
}

TEST(LabelMesh, FillsTwoLabelsWithCommonFaces) {
  const LabelImage image = ball_of_two();
  for (const double size : {3.0, 2.0}) {
    SCOPED_TRACE(size);
    const LabelMesh made = fill_labels(image, size);
    const TetMesh& mesh = made.mesh;
    EXPECT_EQ(made.labels, (std::vector<int>{1, 7}));
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"label_1", "label_7"}));
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_EQ(quality.parts, 1);
    EXPECT_EQ(quality.duplicate_vertices, 0);
    EXPECT_LE(quality.height_ratios.max, 5);
    EXPECT_LE(quality.height_ratios.mean, 2.5);
    EXPECT_NEAR(quality.edges.mean, size, 0.15 * size);
    EXPECT_TRUE(overlap_at_a_face(mesh).empty());
    SurfaceReport report;
    count_edges(boundary_surface(mesh).surface, report);
    EXPECT_EQ(report.open_edges, 0);

    const double voxels = static_cast<double>(
        std::ranges::count_if(image.labels, [](int label) { return label > 0; }));
    EXPECT_NEAR(quality.volume, voxels / 4, 0.03 * voxels / 4);
    for (const auto& [label, part] : made.filled_part) EXPECT_NEAR(part, 1, 0.1) << label;
    double worst = 0, mean = 0;
    const BoundarySurface boundary = boundary_surface(mesh);
    for (const Point& x : boundary.surface.vertices)
      worst = std::max(worst, std::abs(x.norm() - 10)),
      mean += std::abs(x.norm() - 10) / static_cast<double>(boundary.surface.vertices.size());
    EXPECT_LE(mean, 0.15 * size);
    EXPECT_LE(worst, 0.75 * size);
    // tetrahedra of the two regions are on their sides of the plane
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      double x = 0;
      for (const int v : mesh.tets[t]) x += mesh.vertices[static_cast<std::size_t>(v)][0] / 4;
      if (std::abs(x - 2.5) > 0.8 * size) {
        EXPECT_EQ(mesh.region[t], x > 2.5 ? 1 : 0);
      }
    }
  }
  EXPECT_EQ(fill_labels(image, 3).mesh.vertices, fill_labels(image, 3).mesh.vertices);
}

TEST(LabelMesh, SaysWhatIsTooThin) {
  LabelImage image;
  image.size = {24, 24, 24};
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) {
        const int outermost =
            std::max({std::abs(2 * i - 23), std::abs(2 * j - 23), std::abs(2 * k - 23)});
        image.labels.push_back(i == 12 && j == 12 && k == 12 ? 3 : outermost < 17 ? 2 : 0);
      }
  image.names = {{2, "organ"}, {3, "organ"}};
  const LabelMesh made = fill_labels(image, 5);
  EXPECT_EQ(made.labels, std::vector<int>{2});
  EXPECT_EQ(made.mesh.region_names, std::vector<std::string>{"organ"});
  EXPECT_EQ(made.filled_part.at(3), 0);
  EXPECT_NEAR(made.filled_part.at(2), 1, 0.15);
}

TEST(LabelMesh, BadInputIsRefused) {
  LabelImage image;
  image.size = {4, 4, 4};
  image.labels.assign(64, 0);
  EXPECT_NE(refusal([&] { fill_labels(image, 1); }).find("no voxel with a label above 0"),
            std::string::npos);
  image.labels.assign(64, 1);
  EXPECT_NE(refusal([&] { fill_labels(image, 5); }).find("larger than the body"),
            std::string::npos);
  EXPECT_NE(refusal([&] { fill_labels(image, 0.01); }).find("cubes; 2e+06 at most"),
            std::string::npos);
  for (const double size : {0.0, -1.0, std::nan("")})
    EXPECT_NE(refusal([&] { fill_labels(image, size); }).find("the size of tetrahedra is"),
              std::string::npos);
}

}  // namespace
