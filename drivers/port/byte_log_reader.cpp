// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

#include "core/counted.hpp"
#include "core/utc_text.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::drivers::port {
namespace {

using pcapng::Damage;

/// A comment may hold several lines: some programs keep one comment a packet, and a person writes below what is there.
std::vector<std::string_view> lines_of(const std::vector<std::string_view>& comments) {
  std::vector<std::string_view> lines;
  for (std::string_view rest : comments) {
    while (!rest.empty()) {
      const std::size_t end = rest.find_first_of("\r\n");
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      while (line.ends_with(' ') || line.ends_with('\0')) line.remove_suffix(1);
      if (!line.empty()) lines.push_back(line);
    }
  }
  return lines;
}

std::optional<PortId> port_of(const pcapng::Interface& interface) {
  for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
    if (interface.name == name_of(port)) return port;
  }
  return std::nullopt;
}

std::string text_of(const pcapng::Interface& interface) {
  return (interface.name.empty() ? "without a name" : interface.name) + " (link type " +
         std::to_string(interface.link_type) + ")";
}

}  // namespace

ByteLogReader::ByteLogReader(std::filesystem::path file) : file_{std::move(file)} {
  try {
    (void)file_.next();  // the section header
    begin_section();
  } catch (const Damage& damage) {
    file_.refuse("not a whole recording: " + damage.why);
  }
}

LogFaults ByteLogReader::faults() const {
  LogFaults faults = audit_.faults(file_.path().string(), at_end_);
  faults.cut = cut_;
  faults.lacks_end = faults.lacks_end || cut_;
  return faults;
}

void ByteLogReader::end_at_cut(const std::string& why) {
  LogCut cut{file_.block_at(), size_bytes() - file_.block_at(), last_record_, {}};
  cut.text = file_.path().string() + ": byte " + std::to_string(cut.byte) + ": cut short, " + why + "; " +
             counted(cut.unread_bytes, "byte is", "bytes are") + " left out, ";
  if (last_record_) {
    char after[32];
    (void)std::snprintf(after, sizeof after, "%.3f", seconds(*last_record_ - *first_record_));
    cut.text += "the last whole record is of " + utc_text(*last_record_) + ", " + after + " s after the first";
  } else {
    cut.text += "no record is whole";
  }
  cut_ = std::move(cut);
}

void ByteLogReader::refuse_without_ports() {
  const PortId missing = met_[0] ? PortId::kLaser : PortId::kRobot;
  std::string why = "not a recording: no interface is named " + std::string(name_of(missing));
  if (!foreign_.empty()) why += "; neither robot nor laser is " + foreign_;
  file_.refuse(why);
}

std::optional<ByteRecord> ByteLogReader::next() {
  if (cut_) return std::nullopt;
  try {
    if (waiting_.empty() && !read_on()) {
      if (!header_is_whole()) refuse_without_ports();
      at_end_ = true;
      return std::nullopt;
    }
  } catch (const Damage& damage) {
    if (!header_is_whole()) file_.refuse("not a whole recording: " + damage.why);
    end_at_cut(damage.why);
    return std::nullopt;
  }
  ByteRecord record = std::move(waiting_.front());
  waiting_.pop_front();
  return record;
}

bool ByteLogReader::read_on() {
  while (const auto type = file_.next()) {
    if (*type == pcapng::kSectionHeader) begin_section();
    if (*type == pcapng::kInterfaceDescription) read_interface();
    if (*type == pcapng::kEnhancedPacket) read_packet();
    if (*type == pcapng::kSimplePacket || *type == pcapng::kObsoletePacket) audit_.stampless(file_.block_at());
    if (!waiting_.empty()) return true;
  }
  return false;
}

void ByteLogReader::begin_section() {
  sources_.clear();  // numbers of interfaces count from 0 in each section
  if (pcapng::is_written_by_us(file_.body())) audit_.is_ours();
}

void ByteLogReader::read_interface() {
  Source source{pcapng::interface_in(file_.body()), std::nullopt};
  source.port = port_of(source.interface);
  if (!source.port) {
    foreign_ += (foreign_.empty() ? "" : ", ") + text_of(source.interface);
  } else {
    if (source.interface.ticks_per_s == 0) file_.refuse("stamps finer than a nanosecond are not supported");
    met_[static_cast<std::size_t>(*source.port)] = true;
  }
  sources_.push_back(std::move(source));
}

void ByteLogReader::read_packet() {
  const pcapng::Packet packet = pcapng::packet_in(file_.body());
  if (packet.interface >= sources_.size()) throw Damage{"a packet of an interface that was not described"};
  Source& source = sources_[packet.interface];
  if (!source.port) return audit_.foreign(text_of(source.interface));
  ByteRecord record;
  record.port = *source.port;
  record.direction = packet.went_out ? Direction::kOut : Direction::kIn;
  record.stamp = stamp_of(packet, source.interface);
  record.bytes.assign(packet.bytes.begin(), packet.bytes.end());
  std::optional<PacketSeal> seal;
  if (packet.id) seal = seal_of_id(*packet.id);
  begin(source, seal);
  if (!seal) {
    audit_.unnumbered(file_.block_at());
    if (!record.bytes.empty() && !packet.tells_direction) audit_.undirected(file_.block_at());
  }
  if (packet.bytes_cut_off > 0) {
    return audit_.snapped(seal ? std::optional{seal->number} : std::nullopt, file_.block_at());
  }
  seal ? take_sealed(std::move(record), packet.comments, *seal) : take_unsealed(std::move(record), packet.comments);
}

/// The first packet of a port says at which baud it begins, unless it goes on where another part of the same recording
/// has ended.
void ByteLogReader::begin(Source& source, const std::optional<PacketSeal>& seal) {
  const bool is_first = seal && seal->number == 0;
  if (is_first) {
    for (Source& other : sources_) other.has_begun = false;
  }
  if (source.has_begun) return;
  source.has_begun = true;
  const bool goes_on = seal && !is_first && audit_.is_next(seal->number);
  unsigned& baud = bauds_[static_cast<std::size_t>(*source.port)];
  if (!goes_on || baud == 0) baud = source.interface.baud;
}

/// Finds among the packet's comment lines the note whose checksum the seal has; the other lines are people's remarks.
void ByteLogReader::take_sealed(ByteRecord record, const std::vector<std::string_view>& comments,
                                const PacketSeal& seal) {
  std::vector<std::string_view> candidates = lines_of(comments);
  candidates.insert(candidates.begin(), std::string_view{});
  const auto note = std::find_if(candidates.begin(), candidates.end(), [&](std::string_view candidate) {
    return sealed_checksum(seal.number, record, candidate) == seal.checksum;
  });
  if (note == candidates.end()) return audit_.changed(seal.number, file_.block_at());
  audit_.sealed(seal.number, file_.block_at());
  record.note = *note;
  hand_over(std::move(record));
}

/// Recordings of earlier versions have no seal that tells notes from remarks: every comment line is handed over.
void ByteLogReader::take_unsealed(ByteRecord record, const std::vector<std::string_view>& comments) {
  std::vector<std::string_view> lines = lines_of(comments);
  if (record.bytes.empty() && lines.empty()) return audit_.silenced(file_.block_at());
  if (!lines.empty()) {
    record.note = lines.back();
    lines.pop_back();
  }
  for (const std::string_view line : lines) {
    ByteRecord note;
    note.port = record.port;
    note.stamp = record.stamp;
    note.note = line;
    hand_over(std::move(note));
  }
  hand_over(std::move(record));
}

void ByteLogReader::hand_over(ByteRecord record) {
  if (const auto told = end_of_note(record.note)) {
    audit_.is_ours();
    return audit_.end(*told, record.stamp);
  }
  unsigned& baud = bauds_[static_cast<std::size_t>(record.port)];
  if (const auto noted = baud_of_note(record.note)) {
    audit_.is_ours();
    baud = *noted;
  }
  record.baud = baud;
  if (!first_record_) first_record_ = record.stamp;
  last_record_ = record.stamp;
  waiting_.push_back(std::move(record));
}

}  // namespace deltamap::drivers::port
