// SPDX-License-Identifier: Apache-2.0
// The page in words of an incident.
#include <cstdio>
#include <string>

#include "core/geometry/angle.hpp"
#include "core/utc_text.hpp"
#include "daemon/incidents/incident.hpp"

namespace deltamap::daemon {
namespace {

const char* what_to_do(IncidentKind kind) {
  switch (kind) {
    case IncidentKind::kMark:
      return "Look at what the operator has seen: replay the recording and read the log.";
    case IncidentKind::kLost:
      return "See whether the surroundings have changed so much that the map no longer tells the place, whether the "
             "laser was covered or turned, and whether the wheels slipped. Where the robot stands somewhere else than "
             "it believes, say so: deltamap ctl relocalize X,Y,DEG.";
    case IncidentKind::kKidnapped:
      return "See whether somebody has carried or pushed the robot, and whether two places look alike to the laser. "
             "Changes that were written by the wrong pose are taken back by themselves; see deltamap map history.";
    case IncidentKind::kRefusals:
      return "The map could not be brought up to date several times in a row: the log names the reasons. See whether "
             "the pose was unsure there, and whether what has changed keeps moving.";
    case IncidentKind::kSafetyStop:
      return "See what the robot met. Where the stop waits for a person: remove the cause, then deltamap ctl drive "
             "wander.";
    case IncidentKind::kDeviceFault:
      return "Look at the device, its cable and its power. The log tells what it said last.";
    case IncidentKind::kDaemonEnded:
      return "See whether the machine lost its power, whether the kernel ended the process for its memory "
             "(journalctl -k) or the watchdog did (journalctl -u deltamap), and whether it crashed (coredumpctl list "
             "deltamapd). The service has started again by itself.";
  }
  return "";
}

std::string events_text(const Incident& incident) {
  std::string text;
  for (const IncidentEvent& event : incident.events) {
    text += "  " + utc_text(event.time) + "  " + std::string(name_of(event.kind)) + ": " + event.words + "\n";
  }
  return text;
}

std::string where_text(const Incident& incident) {
  if (!incident.map_from_robot) return "No scan had been localized by then: nobody knows where the robot stood.\n";
  const Pose2& pose = *incident.map_from_robot;
  char text[256];
  (void)std::snprintf(text, sizeof text,
                      "x = %.2f m, y = %.2f m, heading %.0f° in the map, by the newest scan before; that pose %s "
                      "(deviation %.2f m).\n",
                      pose.x, pose.y, degrees(pose.theta), incident.is_sure ? "was believed" : "was in doubt",
                      incident.deviation_m);
  return text;
}

std::string kept_text(const Incident& incident) {
  const Timestamp event = incident.events.front().time;
  char text[512];
  if (incident.to) {
    (void)std::snprintf(text, sizeof text,
                        "%s holds every byte of both devices from %.0f s before the first event to %.0f s after it.",
                        kIncidentRecording, seconds(event - incident.from), seconds(*incident.to - event));
  } else {
    (void)std::snprintf(
        text, sizeof text,
        "%s holds every byte of both devices from %.0f s before the first event on. This page is "
        "written again when half a minute has passed, or at the next start of a daemon that ended before.",
        kIncidentRecording, seconds(event - incident.from));
  }
  const std::string lacks = incident.lacks.empty() ? "" : " It is not complete: " + incident.lacks + ".";
  return text + lacks +
         (incident.begins_in_mid_run
              ? " It begins in mid-run: a replay begins with the pose, its deviation, the map and what had proven "
                "stable by then, and decides by itself; votes on changes begin anew.\n"
          : incident.is_complete() ? " It begins with the run: a replay by these settings repeats it bit for bit.\n"
                                   : " It begins with the run.\n");
}

/// The legend of daemon/incidents/incident_picture.
std::string picture_text() {
  return std::string(kIncidentPicture) +
         " shows that moment: the map (black: obstacles, grey: unknown), the newest scan (green where a beam ends at "
         "an obstacle of the map, orange where it does not), the robot with its heading and where it is by 95 % "
         "(blue), "
         "and the best other pose, if there was one (purple).\n";
}

}  // namespace

std::string words_of(const Incident& incident, bool has_picture) {
  const IncidentEvent& first = incident.events.front();
  std::string text = incident.name + "\n\nWhat happened\n\n" + events_text(incident);
  text += "\nWhere\n\n" + where_text(incident);
  text += "Map: revision " + std::to_string(incident.revision) + " of " +
          (incident.first_map.empty() ? "the first map" : incident.first_map) + "\n";
  text += "\nWhat to do\n\n" + std::string(what_to_do(first.kind)) + "\n";
  text += "\nWhat is kept\n\n" + kept_text(incident);
  text += std::string(kIncidentMap) + " is the map that the recording begins on (revision " +
          std::to_string(incident.first_revision) + "), " + kIncidentSettings + " the settings, " + kIncidentLog +
          " the log.\n" + (has_picture ? picture_text() : "");
  text += "\n  deltamap incident open " + incident.name + "      replay it in the page\n  deltamap incident replay " +
          incident.name + "    whether a replay meets the same\n  deltamap incident pack " + incident.name +
          "      one file to send\n\ndeltamapd " + incident.version + "\n";
  return text;
}

}  // namespace deltamap::daemon
