// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/terminal.hpp"

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include "drivers/port/port_holder.hpp"
#include "drivers/port/port_permission.hpp"

namespace deltamap::drivers::port {
namespace {

constexpr std::array<std::pair<unsigned, speed_t>, 8> kSpeeds{{{9600, B9600},
                                                               {19200, B19200},
                                                               {38400, B38400},
                                                               {57600, B57600},
                                                               {115200, B115200},
                                                               {230400, B230400},
                                                               {460800, B460800},
                                                               {500000, B500000}}};

std::optional<speed_t> speed_of(unsigned baud) {
  for (const auto& [known, speed] : kSpeeds) {
    if (known == baud) return speed;
  }
  return std::nullopt;
}

bool is_open_pseudo_terminal(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && is_pseudo_terminal(status.st_rdev);
}

/// Sets the line to 8N1, without translation, flow control or modem lines.
bool set_raw(int descriptor) {
  termios line{};
  if (::tcgetattr(descriptor, &line) != 0) return false;
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS | HUPCL);
  line.c_cc[VMIN] = 1;
  line.c_cc[VTIME] = 0;
  return ::tcsetattr(descriptor, TCSANOW, &line) == 0;
}

/// FTDI adapters hold bytes back for 16 ms unless asked not to (protocols.md B7). Others refuse: no harm.
void ask_for_low_latency(int descriptor) {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  (void)::ioctl(descriptor, TIOCSSERIAL, &settings);
}

/// Whether another program has made the device exclusive. open() refuses everyone but root then, so root has to look.
/// A pseudo-terminal may still be exclusive although nobody has it open.
bool is_exclusive(int descriptor) {
  int exclusive = 0;
  return ::ioctl(descriptor, TIOCGEXCL, &exclusive) == 0 && exclusive != 0;
}

/// Takes the device for this process; empty where that worked, else the reason. flock() keeps out other daemons, root's
/// too; TIOCEXCL keeps out all other programs. A pseudo-terminal gets the lock alone: after a crash it would stay
/// exclusive for as long as the simulator holds its other end.
std::string own_exclusively(const std::string& path, int descriptor) {
  if (const auto holder = lock_file_holder(path, kLockFolder)) {
    return "is busy: " + holder->told() + " has a lock file in " + kLockFolder;
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return why_not_opened(path, errno, descriptor);
  if (is_exclusive(descriptor)) {
    const PortHolders holders = holders_of(path, descriptor);
    if (!holders.seen.empty() || !holders.saw_all) return "is busy: " + holders.told() + " for itself alone";
  }
  if (is_open_pseudo_terminal(descriptor) || ::ioctl(descriptor, TIOCEXCL) == 0) return "";
  return why_not_opened(path, errno, descriptor);
}

std::string is_forbidden(int error) { return "is forbidden (" + std::generic_category().message(error) + "): "; }

}  // namespace

bool is_pseudo_terminal(dev_t number) { return major(number) >= 136 && major(number) <= 143; }

std::string why_not_opened(const std::string& path, int error, int own_descriptor) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "is missing (" + std::generic_category().message(error) + "): not plugged in or switched on?";
    case EBUSY:
    case EWOULDBLOCK:
      return "is busy: " + lockers_or_holders_of(path, own_descriptor).told();
    case EPERM:  // file permissions refuse with EACCES; EPERM comes from DevicePolicy= of a service
      return is_forbidden(error) + why_the_unit_forbids(path);
    case EACCES:
      return is_forbidden(error) + way_to_permission(path);
    default:
      return "cannot be opened: " + std::generic_category().message(error);
  }
}

OpenedTerminal open_terminal(const std::string& path, unsigned baud) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return {-1, path + " " + why_not_opened(path, errno)};
  const auto refuse = [&](const std::string& why) {
    ::close(descriptor);
    return OpenedTerminal{-1, path + " " + why};
  };
  if (::isatty(descriptor) != 1) return refuse("is not a serial port");
  if (const std::string why = own_exclusively(path, descriptor); !why.empty()) return refuse(why);
  if (!set_raw(descriptor)) return refuse(why_not_opened(path, errno));
  ask_for_low_latency(descriptor);
  if (const std::string why = set_line_speed(descriptor, baud); !why.empty()) {
    close_terminal(descriptor);
    return {-1, path + " " + why};
  }
  discard_unread_bytes(descriptor);
  return {descriptor, ""};
}

void close_terminal(int descriptor) {
  if (!is_open_pseudo_terminal(descriptor)) (void)::ioctl(descriptor, TIOCNXCL);  // never set on those
  ::close(descriptor);
}

std::string set_line_speed(int descriptor, unsigned baud) {
  const auto speed = speed_of(baud);
  if (!speed) return "cannot run at " + std::to_string(baud) + " baud";
  termios line{};
  if (::tcgetattr(descriptor, &line) != 0 || ::cfsetspeed(&line, *speed) != 0 ||
      ::tcsetattr(descriptor, TCSANOW, &line) != 0) {
    return "cannot run at " + std::to_string(baud) + " baud: " + std::generic_category().message(errno);
  }
  return "";
}

int unsent_bytes(int descriptor) {
  int count = 0;
  return ::ioctl(descriptor, TIOCOUTQ, &count) == 0 ? count : 0;
}

void discard_unread_bytes(int descriptor) { (void)::tcflush(descriptor, TCIFLUSH); }

}  // namespace deltamap::drivers::port
