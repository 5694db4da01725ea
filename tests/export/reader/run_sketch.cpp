#include "Arduino.h"
#include SKETCH

/* A ratiometric gauge of 0 to 100 kPa, 0.04 to 0.94 of the supply, on a converter of ten bits. */
int analogRead(int) { return (int)std::lround((0.04f + 0.009f * applied_kPa) * 1023.0f); }

int main() {
    applied_kPa = 12.0f;
    setup();
    for (int k = 0; k < 400; k++) {
        applied_kPa = k < 200 ? 12.0f : 15.0f;
        clock_ms += 10;
        loop();
    }
}
