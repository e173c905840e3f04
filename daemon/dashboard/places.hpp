// SPDX-License-Identifier: Apache-2.0
// Who leaves where one more comes to a full page. Whoever comes may be somebody who wants to stop the robot, and that
// shows only in what he says: so whoever has just come is given time to say it, and of the others those go first that
// say nothing. Knows no socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace deltamap::daemon::dashboard {

/// What a guest is about; the first ones leave first.
enum class Standing : std::uint8_t {
  kWaits,       ///< has said nothing for a while, or not all, or nothing more
  kIsAnswered,  ///< has asked, and takes the answer
  kViews,       ///< a WebSocket that is shown what there is
  kHasCome,     ///< a moment ago, and has said nothing yet
  kStays        ///< a command that waits for its reply, somebody who drives: leaves for nobody
};

struct Guest {
  std::string from{};     ///< its address; those of one IPv6 network (/64) count as one
  bool is_known = false;  ///< has shown the token
  Standing standing = Standing::kWaits;
  std::uint64_t since = 0;  ///< counts all that have come and changed their standing
};

struct Places {
  std::size_t most = 96;
  std::size_t most_from_one = 64;  ///< of one address
};

/// Of those: strangers before who is known, then by their standing, then who has it longest. Who has just come stays
/// for whoever was heard, as long as those who have just come are no more than half. Null: all must stay.
[[nodiscard]] const Guest* first_to_leave(const std::vector<const Guest*>& guests);

struct Welcome {
  bool is_welcome = true;
  const Guest* leaves = nullptr;  ///< for whoever comes; null: there is room
};
/// Whether one more from that address is welcome, and who leaves for it: one of the same address where that has all
/// places that one may have, else one of the addresses that have the most.
[[nodiscard]] Welcome welcome_for(const std::string& from, const std::vector<const Guest*>& guests,
                                  const Places& places);

}  // namespace deltamap::daemon::dashboard
