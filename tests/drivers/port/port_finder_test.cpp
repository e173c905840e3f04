// SPDX-License-Identifier: Apache-2.0
// Adapters that are pulled out and come back, in a folder that looks like the kernel's view of devices.
#include "drivers/port/port_finder.hpp"

#include <gtest/gtest.h>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

namespace fs = std::filesystem;

class PortFinderTest : public testing::Test {
 protected:
  /// A link /dev/NAME cannot be made here: the settings name the devices themselves.
  void plug(const std::string& name, const std::string& socket, const std::string& serial, int interface = 0) {
    const fs::path adapter = sys() / "devices/pci0000:00/usb1" / socket;
    const fs::path port = adapter / (socket + ":1." + std::to_string(interface)) / name;
    fs::create_directories(port);
    (void)folder_.write(fs::relative(adapter / "idVendor", folder_.path()), "0403\n");
    (void)folder_.write(fs::relative(adapter / "idProduct", folder_.path()), "6001\n");
    (void)folder_.write(fs::relative(adapter / "product", folder_.path()), "FT232R USB UART\n");
    if (!serial.empty()) (void)folder_.write(fs::relative(adapter / "serial", folder_.path()), serial + "\n");
    (void)folder_.write(fs::relative(port / "port_number", folder_.path()), "0\n");
    fs::create_directories(sys() / "class/tty" / name);
    fs::create_symlink(port, sys() / "class/tty" / name / "device");
  }
  void pull(const std::string& name) {
    fs::remove_all(fs::canonical(sys() / "class/tty" / name / "device").parent_path().parent_path());
    fs::remove_all(sys() / "class/tty" / name);
  }
  void terminal(const std::string& name) { fs::create_directories(sys() / "class/tty" / name); }
  [[nodiscard]] fs::path sys() const { return folder_.path() / "sys"; }

  /// Where a device is looked for; the reason where nowhere.
  std::string place(PortId device) {
    const PortFinder::Place place = finder_.place_of(device);
    return place.path + place.refused;
  }

  test::TemporaryFolder folder_;
  PortFinder finder_{"/dev/ttyUSB0", "/dev/ttyUSB1", folder_.path() / "sys"};
};

constexpr const char* kRobotLink = "/dev/deltamap-no-such-link/robot";

TEST_F(PortFinderTest, BeforeADeviceHasAnsweredItsPortIsTheOneOfTheSettings) {
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0");
  plug("ttyUSB0", "1-1", "A");
  plug("ttyUSB1", "1-2", "B");
  plug("ttyUSB2", "1-3", "C");
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB1");
}

class KnownAdapters : public PortFinderTest, public testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    plug("ttyUSB0", "1-1", serial("A"));
    plug("ttyUSB1", "1-2", serial("B"));
    finder_.answered(PortId::kRobot, "/dev/ttyUSB0");
    finder_.answered(PortId::kLaser, "/dev/ttyUSB1");
  }
  static std::string serial(const std::string& text) { return GetParam() ? text : ""; }
};

TEST_P(KnownAdapters, AreFollowedToAnotherNumber) {
  pull("ttyUSB0");
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0") << "it is told as missing there";
  plug("ttyUSB5", "1-1", serial("A"));
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB5");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB1");
}

TEST_P(KnownAdapters, AreFollowedWhereTheyHaveExchangedTheirNumbers) {
  pull("ttyUSB0");
  pull("ttyUSB1");
  plug("ttyUSB0", "1-2", serial("B"));
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB0");
  EXPECT_EQ(place(PortId::kRobot),
            "/dev/ttyUSB0 is now the adapter of the laser, and that of the robot is missing: not plugged in?");
  plug("ttyUSB1", "1-1", serial("A"));
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB1");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB0");
}

TEST_P(KnownAdapters, AnotherAdapterOnTheirPortIsTriedAndOnOtherPortsIsNot) {
  pull("ttyUSB0");
  plug("ttyUSB2", "1-4", serial("C"));
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0");
  plug("ttyUSB0", "1-3", serial("D"));
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0") << "a replaced adapter";
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutSerialNumbers, KnownAdapters, testing::Bool());

TEST_F(PortFinderTest, ASerialNumberIsFollowedToAnotherSocketAKindIsNot) {
  plug("ttyUSB0", "1-1", "A");
  plug("ttyUSB1", "1-2", "");
  finder_.answered(PortId::kRobot, "/dev/ttyUSB0");
  finder_.answered(PortId::kLaser, "/dev/ttyUSB1");
  pull("ttyUSB0");
  pull("ttyUSB1");
  plug("ttyUSB3", "2-1", "A");
  plug("ttyUSB4", "2-2", "");
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB3");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB1");
}

TEST_F(PortFinderTest, TwinsWithOneSerialNumberAreToldApartByTheirSockets) {
  plug("ttyUSB0", "1-1", "0001");
  plug("ttyUSB1", "1-2", "0001");
  finder_.answered(PortId::kRobot, "/dev/ttyUSB0");
  finder_.answered(PortId::kLaser, "/dev/ttyUSB1");
  pull("ttyUSB0");
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB0") << "its twin is the laser's";
  pull("ttyUSB1");
  plug("ttyUSB0", "1-2", "0001");
  plug("ttyUSB1", "1-1", "0001");
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB1");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB0");
}

TEST_F(PortFinderTest, TheChannelsOfOneAdapterAreToldApart) {
  plug("ttyUSB0", "1-1", "A", 0);
  plug("ttyUSB1", "1-1", "A", 1);
  finder_.answered(PortId::kRobot, "/dev/ttyUSB0");
  finder_.answered(PortId::kLaser, "/dev/ttyUSB1");
  pull("ttyUSB0");
  fs::remove_all(sys() / "class/tty/ttyUSB1");
  plug("ttyUSB4", "1-1", "A", 1);
  plug("ttyUSB5", "1-1", "A", 0);
  EXPECT_EQ(place(PortId::kRobot), "/dev/ttyUSB5");
  EXPECT_EQ(place(PortId::kLaser), "/dev/ttyUSB4");
}

TEST_F(PortFinderTest, TellsWhichOtherPortsAreHere) {
  terminal("tty0");
  terminal("ttyS0");
  EXPECT_EQ(finder_.others_here(PortId::kRobot), "");
  plug("ttyUSB1", "1-2", "B");
  EXPECT_EQ(finder_.others_here(PortId::kRobot), "") << "the laser's, by the settings";
  plug("ttyUSB2", "1-1", "A");
  EXPECT_EQ(finder_.others_here(PortId::kRobot),
            "; here is /dev/ttyUSB2 (FT232R USB UART, serial A, USB 1-1): is it that one? Set 'robot.port'");
  plug("ttyACM0", "1-3", "");
  EXPECT_EQ(finder_.others_here(PortId::kRobot),
            "; here is /dev/ttyACM0 (FT232R USB UART, USB 1-3), /dev/ttyUSB2 (FT232R USB UART, serial A, USB 1-1): is "
            "it that one? Set 'robot.port'");
}

TEST_F(PortFinderTest, PortsThatAreNoUsbAdaptersStayWhatTheyAre) {
  PortFinder finder{"/dev/null", kRobotLink, sys()};
  finder.answered(PortId::kRobot, "/dev/null");
  finder.answered(PortId::kLaser, kRobotLink);
  plug("ttyUSB0", "1-1", "A");
  EXPECT_EQ(finder.place_of(PortId::kRobot).path, "/dev/null");
  EXPECT_EQ(finder.place_of(PortId::kLaser).path, kRobotLink);
}

}  // namespace
}  // namespace deltamap::drivers::port
