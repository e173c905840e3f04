// SPDX-License-Identifier: Apache-2.0
#include "tool/import/import_messages.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>
#include <system_error>

#include "core/counted.hpp"
#include "core/files/scratch_folder.hpp"
#include "core/files/shortest_text.hpp"
#include "core/geometry/angle.hpp"
#include "tool/import/message_log.hpp"
#include "tool/import/ros_messages.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

/// A file's bytes, of which only what is read comes into memory.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat about {};
    const bool is_open = descriptor >= 0 && ::fstat(descriptor, &about) == 0;
    if (is_open && S_ISREG(about.st_mode) && about.st_size > 0) {
      size_ = static_cast<std::size_t>(about.st_size);
      void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
      at_ = at == MAP_FAILED ? nullptr : at;
    }
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!is_open) throw std::runtime_error(file.string() + ": " + std::generic_category().message(error));
    if (!S_ISREG(about.st_mode)) throw std::runtime_error(file.string() + ": is no file");
    if (about.st_size == 0) throw std::runtime_error(file.string() + ": is empty");
    if (at_ == nullptr) throw std::runtime_error(file.string() + ": " + std::generic_category().message(error));
  }
  ~MappedFile() {
    if (at_ != nullptr) ::munmap(at_, size_);
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(at_), size_}; }

 private:
  void* at_ = nullptr;
  std::size_t size_ = 0;
};

MessageFile read_message_file(const MessageImport& wanted, const TakeMessage& take) {
  const MappedFile file{wanted.file};
  try {
    return wanted.is_bag ? read_bag(file.bytes(), take) : read_mcap(file.bytes(), take);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(wanted.file.string() + ": " + error.what());
  }
}

std::string topics_of(const MessageFile& file) {
  std::string text;
  for (const auto& [name, topic] : file.topics) {
    text += (text.empty() ? "" : ", ") + name + " (" + topic.type +
            (topic.encoding.empty() ? "" : ", " + topic.encoding) + ", " + counted(topic.messages, "message") + ")";
  }
  return text.empty() ? "it holds no topic" : "it holds " + text;
}

using Reads = bool (*)(std::string_view, std::string_view);

/// The topic that was asked for, or the only one of its kind.
std::string chosen_topic(const MessageImport& wanted, const MessageFile& file, const std::string& asked,
                         const char* option, const char* what, Reads reads) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(wanted.file.string() + ": " + why + "; " + topics_of(file));
  };
  if (!asked.empty()) {
    const auto found = file.topics.find(asked);
    if (found == file.topics.end()) refuse("has no topic " + asked);
    if (!reads(found->second.type, found->second.encoding)) refuse(asked + " holds no " + what + " that are read");
    return asked;
  }
  std::string only;
  for (const auto& [name, topic] : file.topics) {
    const bool is_one = reads(topic.type, topic.encoding) && name != "/tf_static";
    if (is_one && !only.empty()) refuse(std::string("has several topics with ") + what + ": name one by " + option);
    if (is_one) only = name;
  }
  if (only.empty()) refuse(std::string("has no topic with ") + what + " that are read");
  return only;
}

struct ReadMessages {
  std::vector<RosScan> scans;
  std::vector<RosPose> poses;
  std::vector<RosPose> transforms;  ///< the first of each child
  std::uint64_t broken = 0;
  std::string first_broken;
};

class Collector {
 public:
  Collector(std::string scan_topic, std::string odom_topic, std::string odom_frame)
      : scan_topic_{std::move(scan_topic)}, odom_topic_{std::move(odom_topic)}, odom_frame_{std::move(odom_frame)} {}

  void take(const MessageView& message) {
    const bool is_scan = message.topic == scan_topic_;
    const bool is_odom = message.topic == odom_topic_;
    const bool is_transforms = holds_transforms(message.type) && is_read_as_poses(message.type, message.encoding);
    if (!is_scan && !is_odom && !is_transforms) return;
    try {
      if (is_scan) return read_.scans.push_back(scan_in(message));
      for (RosPose& pose : poses_in(message)) take_pose(std::move(pose), is_odom, is_transforms);
    } catch (const std::runtime_error& error) {
      if (read_.broken++ == 0) read_.first_broken = std::string(message.topic) + ": " + error.what();
    }
  }
  [[nodiscard]] ReadMessages& read() { return read_; }

 private:
  /// Of transforms those from the odometry's frame are the robot's pose, and the others lead to the laser.
  void take_pose(RosPose pose, bool is_odom, bool is_transform) {
    const bool is_of_robot = !is_transform || pose.frame == odom_frame_;
    if (is_odom && is_of_robot) {
      read_.poses.push_back(std::move(pose));
    } else if (is_transform && !is_of_robot && seen_.insert(pose.child).second) {
      read_.transforms.push_back(std::move(pose));
    }
  }

  std::string scan_topic_;
  std::string odom_topic_;
  std::string odom_frame_;
  std::set<std::string> seen_;
  ReadMessages read_;
};

/// To a micrometre and a millionth of a degree: more digits are of the arithmetic.
std::string rounded_text(double value) { return shortest_text(std::round(1e6 * value) / 1e6 + 0.0); }

std::string settings_line(const ReadMessages& read) {
  const RosScan& scan = read.scans.front();
  std::string line = "settings to use:";
  if (scan.max_range_m > 0.0) line += " --set laser.max_range_m=" + rounded_text(scan.max_range_m);
  const std::string base =
      read.poses.empty() || read.poses.front().child.empty() ? "base_link" : read.poses.front().child;
  const auto base_from_frame = mount_by(read.transforms, scan.frame, base);
  if (!base_from_frame) {
    return line + " laser.mount by hand: no transform tells where \"" + scan.frame + "\" lies in \"" + base + "\"";
  }
  const auto [mount, is_upside_down] = *base_from_frame * scan.frame_from_scan;
  return line + " --set laser.mount.x_m=" + rounded_text(mount.x) + " --set laser.mount.y_m=" + rounded_text(mount.y) +
         " --set laser.mount.yaw_deg=" + rounded_text(degrees(mount.theta)) +
         (is_upside_down ? " --set laser.mount.upside_down=true" : "");
}

std::vector<std::string> notes_of(const ReadMessages& read, const WrittenLog& log) {
  std::vector<std::string> notes{settings_line(read)};
  const RosScan& scan = read.scans.front();
  const double last_rad =
      scan.first_bearing_rad + scan.bearing_step_rad * static_cast<double>(scan.ranges_m.size() - 1);
  constexpr double kHalfFan_rad = 1.5708 + 0.01;
  if (scan.bearing_step_rad < 0.0) notes.emplace_back("the scans tell their beams clockwise: they are turned round");
  if (std::abs(scan.first_bearing_rad) > kHalfFan_rad || std::abs(last_rad) > kHalfFan_rad)
    notes.push_back("the scans reach from " + shortest_text(std::round(degrees(scan.first_bearing_rad))) + " to " +
                    shortest_text(std::round(degrees(last_rad))) + " degrees: what lies beyond 90 is left out");
  if (log.no_returns > 0)
    notes.push_back(counted(log.no_returns, "beam is", "beams are") + " no return (infinite, or at the longest range)");
  if (log.not_valid > 0)
    notes.push_back(counted(log.not_valid, "beam is", "beams are") +
                    " not valid (no number, or below the shortest range)");
  if (read.broken > 0)
    notes.push_back(counted(read.broken, "message is", "messages are") + " left out; the first: " + read.first_broken);
  if (!read.poses.empty() && (scan.time < read.poses.front().time || read.scans.back().time > read.poses.back().time))
    notes.emplace_back("scans before the first and after the last pose stand at these");
  return notes;
}

}  // namespace

ImportedMessages import_messages(const MessageImport& wanted) {
  std::error_code ignored;
  if (std::filesystem::equivalent(wanted.file, wanted.recording, ignored))
    throw std::runtime_error(wanted.recording.string() + ": is the file that is read itself");
  const MessageFile file = read_message_file(wanted, [](const MessageView&) {});
  const std::string scan_topic = chosen_topic(wanted, file, wanted.scan_topic, "--scan", "scans", is_read_as_scan);
  const std::string odom_topic = chosen_topic(wanted, file, wanted.odom_topic, "--odom", "poses", is_read_as_poses);
  Collector collector{scan_topic, odom_topic, wanted.odom_frame};
  (void)read_message_file(wanted, [&](const MessageView& message) { collector.take(message); });
  ReadMessages& read = collector.read();
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(wanted.file.string() + ": " + why +
                             (read.first_broken.empty() ? "" : "; " + read.first_broken));
  };
  if (read.scans.empty()) refuse(scan_topic + " holds no scan that can be read");
  if (read.poses.empty()) {
    const bool is_of_transforms = holds_transforms(file.topics.at(odom_topic).type);
    refuse(odom_topic + (is_of_transforms ? " holds no transform from \"" + wanted.odom_frame + "\" (--odom-frame)"
                                          : " holds no pose that can be read"));
  }
  const ScratchFolder scratch;
  const std::filesystem::path log = scratch.path() / wanted.file.filename();
  const WrittenLog written = write_carmen_log(log, read.scans, read.poses, wanted.no_return_m);
  ImportedMessages done;
  done.notes = notes_of(read, written);
  done.cut = file.cut;
  done.carmen = import_carmen(log, wanted.recording, written.no_return_m.value_or(0.0));
  done.carmen.survey.no_return_m = wanted.no_return_m;  // what stands for it in between is nobody's business
  return done;
}

namespace {

void add_import_of(CLI::App& import, const char* name, const char* what) {
  struct Options {
    MessageImport wanted;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  options->wanted.is_bag = std::string_view{name} == "bag";
  CLI::App& command = *import.add_subcommand(name, what);
  command.add_option("FILE", options->wanted.file, "file to read")->required();
  command.add_option("--out", options->wanted.recording, "recording to write (.pcapng)")->required();
  command.add_option("--scan", options->wanted.scan_topic, "topic of the scans (default: the only one)");
  command.add_option("--odom", options->wanted.odom_topic,
                     "topic of odometry, poses or transforms (default: the only one)");
  command.add_option("--odom-frame", options->wanted.odom_frame,
                     "of transforms: the frame of the odometry (default odom)");
  command
      .add_option("--no-return", options->wanted.no_return_m, "ranges of this many metres and more are no return, too")
      ->check(CLI::PositiveNumber);
  command.add_flag("--json", options->json, "print the result as JSON");
  command.callback([options] {
    ImportedMessages done = import_messages(options->wanted);
    if (!done.cut.empty())
      std::cerr << "deltamap: warning: " << options->wanted.file.string() << ": " << done.cut
                << "; what is before is used\n";
    done.carmen.survey.notes.insert(done.carmen.survey.notes.begin(), done.notes.begin(), done.notes.end());
    tell_import(done.carmen, options->wanted.recording.string(), options->json);
  });
}

}  // namespace

void add_import_messages(CLI::App& import) {
  add_import_of(import, "bag", "scans and odometry of a ROS 1 bag as the bytes of a P3-DX and an LMS200");
  add_import_of(import, "mcap", "scans and odometry of an MCAP file as the bytes of a P3-DX and an LMS200");
}

}  // namespace deltamap::tool
