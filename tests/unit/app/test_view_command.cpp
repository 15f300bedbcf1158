// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

constexpr const char* soft_block = R"(duration: 1 s
gravity: [0, 0, -9.81]
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}]
  material: {model: st_venant_kirchhoff, young_modulus: 20 kPa, poisson_ratio: 0.3, density: 1000}
  fixed: [{half_space: {normal: [0, 0, 1]}}]
  damping: {mass: 8}
  surface: {boundary: true}
contact: {obstacles: [{name: probe, sphere: {centre: [0.13, 0.05, 0.08], radius: 0.02}}]}
integration: {macro_step: 1 ms}
)";

class ViewCommand : public ProgramTest {
 protected:
  ViewCommand() : ProgramTest(soft_block) {}
};

TEST_F(ViewCommand, AMousePullsTheBodyAndABallPushesIt) {
  const Child used = run_child(
      {python(), PLICA_SOURCE_DIR "/tests/unit/app/use_view.py", PLICA_EXECUTABLE, scene}, folder);
  if (used.status == 77) GTEST_SKIP() << used.output;
  EXPECT_EQ(used.status, 0) << used.errors;
}

TEST_F(ViewCommand, APortInUseIsNamedAtOnce) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(socket, 1), 0);
  ASSERT_EQ(getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  // The scene is bad as well: it is not read, and nothing is set up
  const Child child =
      plica({"view", scene, "--set", "body.fixed=3", "--no-browser", "--port", port});
  close(socket);
  EXPECT_EQ(child.status, 2);
  EXPECT_NE(child.errors.find("port " + port + " is in use"), std::string::npos) << child.errors;
  EXPECT_NE(child.errors.find("choose another port (0: any free one)"), std::string::npos)
      << child.errors;
  EXPECT_EQ(child.errors.find("body.fixed"), std::string::npos) << child.errors;
}

TEST_F(ViewCommand, BadScenesAreBadHereToo) {
  const Child child = plica({"view", scene, "--set", "body.fixed=3", "--no-browser"});
  EXPECT_EQ(child.status, 2);
  EXPECT_NE(child.errors.find("body.fixed"), std::string::npos) << child.errors;
}

}  // namespace
}  // namespace plica::app::test
