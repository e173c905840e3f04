#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: when a program's window loses the keyboard, SDL either goes on reading the joystick, or lets its axes and buttons go.
# Seen: neither. What is pushed stays pushed; from then on an axis may only come nearer to zero, on the side where it is, and
#   a button only be let go. A stick at 20000 that is pulled back through 3000 and -3000 to -20000 stays at 3000: ahead.
# Matters: the driver of a robot sees another window come up, pulls the stick back with all force, and the robot creeps on.
#   Let go, it stops. A window that opens later, without the keyboard, is enough: without any window all events come.
# Version: SDL 2.26.5 (2.26.5+dfsg-1). Source: SDL_hints.h, SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS: without it joystick
#   events are disabled in the background; nothing is said of the state that is left.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libsdl2-2.0-0=2.26.5+dfsg-1
debian_files libsdl2-dev=2.26.5+dfsg-1
cat > stick.cpp << 'CPP'
#include <SDL2/SDL.h>

#include <cstdio>
#include <initializer_list>

int main(int, char**) {
  SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");  // no window of it ever has the keyboard
  SDL_Init(SDL_INIT_VIDEO | SDL_INIT_JOYSTICK);
  SDL_Joystick* stick = SDL_JoystickOpen(SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, 1, 1, 0));
  SDL_Event event;
  const auto move = [&](Sint16 to, Uint8 button) {
    SDL_JoystickSetVirtualAxis(stick, 0, to);
    SDL_JoystickSetVirtualButton(stick, 0, button);
    while (SDL_PollEvent(&event)) continue;
    std::printf("%d/%d is %d/%d, ", to, button, SDL_JoystickGetAxis(stick, 0), SDL_JoystickGetButton(stick, 0));
  };
  for (const Sint16 to : {0, -9000, 20000}) move(to, 1);
  SDL_CreateWindow("map", 0, 0, 100, 100, 0);
  while (SDL_PollEvent(&event)) continue;
  std::printf("window without keyboard %d: ", SDL_GetKeyboardFocus() == nullptr);
  for (const Sint16 to : {30000, 20000, 3000, -3000, -20000}) move(to, 1);
  for (const Uint8 button : {0, 1}) move(0, button);
}
CPP
compiled stick.cpp -I "$root/usr/include/x86_64-linux-gnu" -l:libSDL2-2.0.so.0
expected='0/1 is 0/1, -9000/1 is -9000/1, 20000/1 is 20000/1, window without keyboard 1: 30000/1 is 20000/1, 20000/1 is 20000/1, '
expected+='3000/1 is 3000/1, -3000/1 is 3000/1, -20000/1 is 3000/1, 0/0 is 0/0, 0/1 is 0/0, '
stated 'pushed to' "$expected" "$(with_libraries ./run)"
