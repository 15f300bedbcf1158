// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// From now on the first Ctrl-C (or SIGTERM) only makes interrupted() true; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace plica::app
