// SPDX-License-Identifier: BSD-3-Clause
#include "msh_text.hpp"

namespace {

using namespace plica::test;

void expect_refused_with(const std::string& from, const std::string& to, int line,
                         const std::vector<std::string>& parts) {
  expect_refused(with(two_tets, from, to), line, parts);
}

TEST(MalformedMsh, OtherFilesAndVersions) {
  expect_refused("", 0, {"$MeshFormat", "the file ends"});
  expect_refused("<?xml version=\"1.0\"?>\n", 1, {"$MeshFormat", "'<?xml version=\"1.0\"?>'"});
  expect_refused_with("2.2 0 8", "4.0 0 8", 2, {"version is '4.0'", "2.2 and 4.1", "-format msh41"});
  expect_refused_with("2.2 0 8", "2.2 2 8", 2, {"'2'", "0 (text) or 1 (binary)"});
  expect_refused_with("2.2 0 8", "2.2 0 4", 2, {"'4'", "expected 8"});
  expect_refused_with("2.2 0 8", "2.2", 2, {"'2.2'", "4.1 0 8"});
  expect_refused_with("$EndMeshFormat", "$End", 3, {"$EndMeshFormat", "'$End'"});
}

TEST(MalformedMsh, Sections) {
  expect_refused_with("$Nodes", "Nodes", 11, {"'Nodes'", "start of a section"});
  expect_refused_with("$Nodes", "$Points", 24, {"'$EndPoints'", "the file ends"});
  expect_refused_with("$Nodes", "$ParametricNodes", 11, {"$ParametricNodes", "parametric"});
  expect_refused(two_tets + "$Nodes\n1\n1 0 0 0\n$EndNodes\n", 25, {"second section $Nodes"});
  expect_refused(two_tets.substr(0, two_tets.find("$Elements")), 18, {"a section $Elements", "the file ends"});
}

TEST(MalformedMsh, Counts) {
  expect_refused_with("$Nodes\n5", "$Nodes\n4", 17, {"$EndNodes after 4 nodes", "'11 1 1 1'"});
  expect_refused_with("$Nodes\n5", "$Nodes\n6", 18, {"node 6 of 6", "'$EndNodes'"});
  expect_refused_with("$Elements\n3", "$Elements\n2", 23, {"$EndElements after 2 elements", "'8 4 2 2 2 2 3 10 11'"});
  expect_refused_with("$Elements\n3", "$Elements\n4", 24, {"element 4 of 4", "'$EndElements'"});
  expect_refused_with("$Nodes\n5", "$Nodes\n99999999999", 12, {"99999999999", "room for"});
  expect_refused_with("$Elements\n3", "$Elements\n2147483648", 20, {"2147483648", "room for"});
  expect_refused_with("$Nodes\n5", "$Nodes\n99999999999999999999", 12, {"'99999999999999999999'", "integer"});
  expect_refused_with("$Nodes\n5", "$Nodes\n-5", 12, {"-5", "number of nodes"});
  expect_refused_with("$Nodes\n5", "$Nodes\nfive", 12, {"'five'", "integer"});
}

TEST(MalformedMsh, Numbers) {
  expect_refused_with("10 0 0 1", "10 0 nan 1", 16, {"coordinate y is 'nan'", "finite"});
  expect_refused_with("10 0 0 1", "10 -inf 0 1", 16, {"coordinate x is '-inf'", "finite"});
  expect_refused_with("10 0 0 1", "10 0 0 1e999", 16, {"coordinate z is '1e999'", "number"});
  expect_refused_with("10 0 0 1", "10 0 0,5 1", 16, {"'0,5'", "number"});
  expect_refused_with("10 0 0 1", "10 0 0", 16, {"'10 0 0'", "coordinate z"});
  expect_refused_with("10 0 0 1", "10 0 0 1 7", 16, {"'10 0 0 1 7'", "three coordinates"});
  expect_refused_with("10 0 0 1", "1.5 0 0 1", 16, {"'1.5'", "integer"});
  expect_refused_with("10 0 0 1", "0 0 0 1", 16, {"node is 0", "1 or more"});
}

TEST(MalformedMsh, Nodes) {
  expect_refused_with("10 0 0 1", "3 0 0 1", 16, {"node 3 is defined again", "line 15"});
  expect_refused_with("1 1 1 2 3 10", "1 1 1 2 3 12", 22, {"tetrahedron 7", "node 12"});
  expect_refused_with("2 4 1 1 2 3", "2 4 1 1 2 99", 21, {"node 99"});
  expect_refused_with("6 2 2 4 1 1 2 3", "6 2 2 0 1 1 2 99", 21, {"node 99"});
}

TEST(MalformedMsh, Tetrahedra) {
  expect_refused_with("1 1 1 2 3 10", "1 1 1 2 3 3", 22, {"tetrahedron 7", "names a node twice: 1 2 3 3"});
  expect_refused_with("2 2 2 3 10 11", "2 2 10 3 2 1", 23, {"tetrahedron 8 repeats tetrahedron 7 on line 22"});
  expect_refused_with("10 0 0 1", "10 1 1 0", 22, {"tetrahedron 7 (nodes 1 2 3 10) has no volume"});
  expect_refused_with("10 0 0 1", "10 1 1 1e-12", 22, {"tetrahedron 7", "longest edge"});
  const std::string triangle_only = with(with(with(two_tets, "7 4 2 1 1 1 2 3 10\n", ""), "8 4 2 2 2 2 3 10 11\n", ""),
                                         "$Elements\n3", "$Elements\n1");
  expect_refused(triangle_only, 0, {"no tetrahedron"});
}

TEST(MalformedMsh, Elements) {
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 5 2 1 1 1 2 3 10 11 1 2 3", 22, {"type 5, a hexahedron", "supported"});
  expect_refused_with("7 4 2", "7 11 2", 22, {"type 11, a second-order tetrahedron"});
  expect_refused_with("6 2 2", "6 9 2", 21, {"type 9, a second-order triangle"});
  expect_refused_with("6 2 2", "6 77 2", 21, {"element 6 has type 77;"});
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 4 2 1 1 1 2 3", 22, {"line ends", "a node of an element"});
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 4 3 1 1 1 2 3 10", 22, {"line ends", "a node of an element"});
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 4 -1 1 1 1 2 3 10", 22, {"number of tags of an element is -1"});
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 4", 22, {"line ends", "number of tags"});
  expect_refused_with("7 4 2 1 1 1 2 3 10", "7 4 2 x 1 1 2 3 10", 22, {"'x'", "physical group"});
  expect_refused_with("7 4 2 1 1", "7 4 2 -9223372036854775808 1", 22, {"-9223372036854775808", "32 bits"});
  expect_refused_with("7 4 2 1 1", "7 4 2 1 ?", 22, {"'?'", "tag"});
}

TEST(MalformedMsh, PhysicalNames) {
  expect_refused_with("2 4 \"base\"", "2 4 base", 6, {"name in quotes", "'2 4 base'"});
  expect_refused_with("2 4 \"base\"", "2 4 \"base", 6, {"name in quotes"});
  expect_refused_with("2 4 \"base\"", "2 4 \"\"", 6, {"name in quotes"});
  expect_refused_with("2 4 \"base\"", "4 4 \"base\"", 6, {"dimension", "is 4", "0 to 3"});
  expect_refused_with("3 2 \"large tumour\"", "3 2 \"tissue\"", 8, {"group 2 'tissue'", "group 1"});
  expect_refused_with("3 2 \"large tumour\"", "3 1 \"other\"", 8, {"group 1 'other'", "'tissue' already"});
}

TEST(MalformedMsh, LongAndUnprintableInputIsCut) {
  expect_refused("\x01" + std::string(100000, 'x'), 1, {"'?" + std::string(59, 'x') + "...'"});
}

}  // namespace
