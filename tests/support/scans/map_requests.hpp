// SPDX-License-Identifier: Apache-2.0
// What Δ-awareness asks of the map, by kind.
#pragma once

#include <optional>
#include <utility>

#include "core/messages.hpp"

namespace deltamap::test {

/// The finished set; none where there is no request, or it is an order.
inline std::optional<ScanSet> set_in(std::optional<MapRequest> request) {
  if (!request || !std::holds_alternative<ScanSet>(*request)) return std::nullopt;
  return std::get<ScanSet>(*std::move(request));
}

inline bool is_withdrawal(const std::optional<MapRequest>& request) {
  return request && std::holds_alternative<WithdrawOrder>(*request);
}

}  // namespace deltamap::test
