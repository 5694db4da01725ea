#include <algorithm>
#include "Arduino.h"
#include SKETCH

/* A ratiometric gauge of 0 to 100 kPa, 0.04 to 0.94 of the supply, on a converter of ten bits. */
int analogRead(int) { return std::min(1023, (int)std::lround((0.04f + 0.009f * applied_kPa) * 1023.0f)); }

int main() {
    applied_kPa = 12.0f;
    setup();
    Serial.sent = '?';
    for (int k = 0; k < 600; k++) {
        /* At the end more than gauge and converter read. */
        applied_kPa = k < 200 ? 12.0f : k < 400 ? 15.0f : 200.0f;
        clock_ms += 10;
        loop();
    }
}
