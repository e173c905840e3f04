// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/access.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace deltamap::daemon::dashboard {
namespace {

constexpr std::string_view kCookie = "deltamap_token=";
constexpr std::string_view kTokenQuery = "token=";
constexpr std::string_view kBearer = "Bearer ";
constexpr std::string_view kLocalhost = "localhost";

std::optional<boost::asio::ip::address> address_of(std::string_view text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(std::string(text), error);
  return error ? std::nullopt : std::optional{address};
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The name in a Host field without brackets and port; nothing where it is neither an IP address nor "localhost". Any
/// port will do: a tunnel may lead here from another one. A page of another site that lets its own name lead here
/// ("DNS rebinding") comes with that name.
std::optional<std::string_view> name_in(std::string_view host) {
  const bool is_bracketed = host.starts_with('[');
  const auto end = is_bracketed ? host.find(']') : host.find(':');
  const std::string_view name = host.substr(is_bracketed ? 1 : 0, is_bracketed ? end - 1 : end);
  std::string_view rest = end == std::string_view::npos ? std::string_view{} : host.substr(end);
  if (is_bracketed && end == std::string_view::npos) return std::nullopt;
  if (is_bracketed) rest.remove_prefix(1);
  if (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1)))) return std::nullopt;
  if (!is_bracketed && name == kLocalhost) return name;
  const auto address = address_of(name);
  return address && address->is_v6() == is_bracketed ? std::optional{name} : std::nullopt;
}

/// True for a request that was sent on this machine to a loopback name. A proxy that forwards requests from outside
/// connects from here as well, but names the outer address.
bool is_local(const Request& request) {
  const auto name = name_in(request.host);
  return request.is_from_loopback && name && (name == kLocalhost || is_loopback(std::string(*name)) == true);
}

bool commands(const Request& request) { return request.path == kCommandPath || request.path == kDrivePath; }

std::string_view cookie_token(std::string_view cookies) {
  while (!cookies.empty()) {
    const auto end = std::min(cookies.find(';'), cookies.size());
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(kCookie)) return one.substr(kCookie.size());
  }
  return {};
}

bool has_token(const Request& request, const std::string& token) {
  const std::string_view bearer = request.authorization;
  if (bearer.starts_with(kBearer) && is_same_secret(bearer.substr(kBearer.size()), token)) return true;
  return is_same_secret(cookie_token(request.cookie), token);
}

Answer refused(unsigned status, std::string why) { return {.status = status, .body = std::move(why) + "\n"}; }

/// True for the media type of JSON, with parameters ("application/json; charset=utf-8") or without.
bool is_json(std::string_view type) {
  constexpr std::string_view kJson = "application/json";
  if (!type.starts_with(kJson)) return false;
  type.remove_prefix(kJson.size());
  return type.empty() || type.front() == ';' || type.front() == ' ';
}

std::optional<Answer> refusal_of_method(const Request& request) {
  const bool is_command = request.path == kCommandPath;
  if (request.method == (is_command ? "POST" : "GET")) return std::nullopt;
  Answer answer =
      refused(405, is_command ? "only POST, with a command as JSON" : "only GET: this is read, not changed");
  answer.headers.emplace_back("Allow", is_command ? "POST" : "GET");
  return answer;
}

/// The refusal of a request that commands or drives, of a sender who is allowed to read the page.
std::optional<Answer> refusal_of_command(const Request& request, const Guard& guard) {
  if (!commands(request)) return std::nullopt;
  if (!guard.takes_commands) return refused(403, "no commands are taken here: 'dashboard.control' is off");
  if (request.path == kDrivePath) {
    return guard.token.empty() ? std::optional{refused(403, std::string(kDrivingNeedsToken))} : std::nullopt;
  }
  if (!is_json(request.content_type)) return refused(415, "a command needs Content-Type: application/json");
  return std::nullopt;
}

bool is_token_character(unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.'; }

}  // namespace

std::optional<bool> is_loopback(const std::string& address) {
  const auto parsed = address_of(address);
  return parsed ? std::optional{parsed->is_loopback()} : std::nullopt;
}

std::string read_token(const std::filesystem::path& file) {
  const auto refuse = [&file](const std::string& why) -> std::runtime_error {
    return std::runtime_error(file.string() + ": no token: " + why);
  };
  std::ifstream in(file);
  std::string token;
  if (!in || std::filesystem::is_directory(file))
    throw refuse(in ? std::string("is a folder") : std::generic_category().message(errno));
  struct stat state {};
  if (::stat(file.c_str(), &state) == 0 && (state.st_mode & S_IROTH) != 0) throw refuse("everybody may read it");
  (void)std::getline(in, token);
  if (token.size() < kShortestToken) throw refuse("needs at least " + std::to_string(kShortestToken) + " characters");
  if (!std::all_of(token.begin(), token.end(), is_token_character)) {
    throw refuse("may hold letters, digits, '-', '_' and '.' only");
  }
  return token;
}

bool is_same_secret(std::string_view given, std::string_view secret) {
  if (given.size() != secret.size() || secret.empty()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    difference = static_cast<unsigned char>(difference | static_cast<unsigned char>(given[i] ^ secret[i]));
  }
  return difference == 0;
}

std::optional<Answer> refusal_of(const Request& request, const Guard& guard) {
  if (auto refusal = refusal_of_method(request)) return refusal;
  if (!name_in(request.host)) {
    return refused(421, "the Host of a request must be an IP address or localhost");
  }
  if (!request.origin.empty() && request.origin != "http://" + request.host) {
    return refused(403, "a page of another origin may not read this one");
  }
  if (guard.token.empty() || has_token(request, guard.token)) return refusal_of_command(request, guard);
  if (is_local(request) && !commands(request)) return std::nullopt;
  Answer answer = refused(401, "a token is needed: open /?token=… once, or send Authorization: Bearer …");
  answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return answer;
}

bool is_known(const Request& request, const Guard& guard) {
  return !guard.token.empty() && has_token(request, guard.token);
}

bool may_stop(const Request& request, const Guard& guard) {
  const Guard without_token{.token = "", .takes_commands = guard.takes_commands};
  return request.path == kCommandPath && is_local(request) && !refusal_of(request, without_token);
}

std::optional<Answer> entry_of(const Request& request, const std::string& token) {
  const std::string_view query = request.query;
  if (request.method != "GET" || !name_in(request.host)) return std::nullopt;
  if (token.empty() || request.path != "/" || !query.starts_with(kTokenQuery)) return std::nullopt;
  if (!is_same_secret(query.substr(kTokenQuery.size()), token)) return std::nullopt;
  Answer answer{.status = 303, .body = ""};
  answer.headers.emplace_back("Location", "/");
  answer.headers.emplace_back("Set-Cookie", std::string(kCookie) + token + "; HttpOnly; SameSite=Strict; Path=/");
  return answer;
}

}  // namespace deltamap::daemon::dashboard
