// SPDX-License-Identifier: Apache-2.0
// Nothing: CMake hangs a precompiled header on a target, and a target has a source.
