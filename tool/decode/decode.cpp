// SPDX-License-Identifier: Apache-2.0
// `deltamap decode robot|laser HEX…` and `deltamap decode REC.pcapng`: frames by name and field, and the garbage
// between them.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/counted.hpp"
#include "tool/decode/decode_recording.hpp"
#include "tool/decode/decoded_frame.hpp"
#include "tool/decode/frame_text.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using Json = nlohmann::ordered_json;

struct DecodeOptions {
  std::string source;
  std::vector<std::string> hex;
  std::optional<std::uint8_t> measuring_mode;
  RecordingToDecode recording;
  bool json = false;

  [[nodiscard]] bool is_line() const { return source == "robot" || source == "laser"; }
};

std::vector<std::uint8_t> bytes_from(const std::vector<std::string>& words) {
  std::vector<std::uint8_t> bytes;
  for (const std::string& word : words) {
    std::string digits;
    for (const char c : word) {
      if (c != ' ' && c != ':' && c != ',') digits.push_back(c);
    }
    if (digits.starts_with("0x") || digits.starts_with("0X")) digits.erase(0, 2);
    const bool is_hex = digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
    if (digits.size() % 2 != 0 || !is_hex) throw CLI::ValidationError("HEX", "\"" + word + "\" is not bytes in hex");
    for (std::size_t i = 0; i < digits.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits.substr(i, 2), nullptr, 16)));
    }
  }
  return bytes;
}

std::string hex_of(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    hex.push_back(kDigits[byte >> 4]);
    hex.push_back(kDigits[byte & 0xF]);
  }
  return hex;
}

struct Garbage {
  std::size_t at = 0;
  std::span<const std::uint8_t> bytes;
};

std::vector<Garbage> garbage_between(const std::vector<DecodedFrame>& frames, std::span<const std::uint8_t> bytes) {
  std::vector<Garbage> garbage;
  std::size_t at = 0;
  const auto add_until = [&](std::size_t end) {
    if (end > at) garbage.push_back({at, bytes.subspan(at, end - at)});
  };
  for (const DecodedFrame& frame : frames) {
    add_until(frame.at);
    at = frame.at + frame.size;
  }
  add_until(bytes.size());
  return garbage;
}

Json json_of_frame(const DecodedFrame& frame) {
  return {{"name", frame.name},
          {"from", frame.from},
          {"at", frame.at},
          {"bytes", frame.size},
          {"fields", Json::parse(json_of(frame.fields))}};
}

void print_json(const DecodedStream& stream, const std::vector<Garbage>& garbage) {
  Json report{{"frames", Json::array()}, {"garbage", Json::array()}};
  for (const DecodedFrame& frame : stream.frames) report["frames"].push_back(json_of_frame(frame));
  for (const Garbage& g : garbage) report["garbage"].push_back({{"at", g.at}, {"hex", hex_of(g.bytes)}});
  std::cout << report.dump(2) << '\n';
}

void print_text(const DecodedStream& stream, const std::vector<Garbage>& garbage) {
  for (const DecodedFrame& frame : stream.frames) {
    std::cout << frame.name << "  (from " << frame.from << ", byte " << frame.at << ", " << counted(frame.size, "byte")
              << ")\n"
              << text_of(frame.fields, std::string::npos);
  }
  for (const Garbage& g : garbage) {
    std::cout << "garbage  (byte " << g.at << ", " << counted(g.bytes.size(), "byte") << "): " << hex_of(g.bytes)
              << '\n';
  }
}

std::string why_nothing(const DecodedStream& stream) {
  if (stream.counts.bad_checksum > 0) return "wrong checksum";
  if (stream.counts.bad_length > 0) return "impossible length";
  if (stream.counts.truncated > 0) return "cut short";
  return "no header";
}

void decode_hex(const DecodeOptions& options) {
  const std::vector<std::uint8_t> bytes = bytes_from(options.hex);
  const DecodedStream stream =
      options.source == "robot" ? decoded_robot_stream(bytes) : decoded_laser_stream(bytes, options.measuring_mode);
  const std::vector<Garbage> garbage = garbage_between(stream.frames, bytes);
  if (options.json) {
    print_json(stream, garbage);
  } else {
    print_text(stream, garbage);
  }
  if (stream.frames.empty()) {
    throw std::runtime_error("decode " + options.source + ": no frame in " + std::to_string(bytes.size()) +
                             " bytes: " + why_nothing(stream));
  }
}

void decode(DecodeOptions& options, const CLI::App& command) {
  if (options.is_line()) {
    for (const char* of_recording : {"--kind", "--from", "--to"}) {
      if (command.count(of_recording) > 0)
        throw CLI::ValidationError(of_recording, "is of a recording: bytes of a line have neither times nor kinds");
    }
    if (options.hex.empty()) throw CLI::ValidationError("HEX", "bytes of the line are missing");
    return decode_hex(options);
  }
  if (!options.hex.empty()) {
    throw CLI::ValidationError("SOURCE", "\"" + options.source + "\" is neither robot nor laser, and HEX is for them");
  }
  options.recording.file = options.source;
  options.recording.measuring_mode = options.measuring_mode;
  options.recording.as_json = options.json;
  decode_recording(options.recording);
}

}  // namespace

void add_decode(CLI::App& app) {
  auto options = std::make_shared<DecodeOptions>();
  RecordingToDecode& recording = options->recording;
  CLI::App* command =
      app.add_subcommand("decode", "frames of a recording, or of bytes of either serial line, by name and field");
  command->add_option("SOURCE", options->source, "a recording; or robot or laser, whose line HEX is of")->required();
  command->add_option("HEX", options->hex, "bytes in hex, in one word or many");
  command
      ->add_option("--measuring-mode", options->measuring_mode,
                   "laser: reads ranges in this mode (byte 5 of 74h); of a recording by default as the laser tells")
      ->check(CLI::Range(0, 63));
  command->add_option("--from", recording.window.from_s, "recording: seconds after the first byte to begin at")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--to", recording.window.to_s, "recording: seconds after the first byte to end at")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--kind", recording.kinds,
                   "recording: only frames of this name (scan, SIP, VEL, note, garbage, ...); repeatable")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "print JSON; of a recording a line each");
  command->callback([options, command] { decode(*options, *command); });
}

}  // namespace deltamap::tool
