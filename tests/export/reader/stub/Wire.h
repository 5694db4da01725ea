#pragma once
#include <algorithm>
#include "Arduino.h"
struct Bus {
    int sent = 0, at = 0;
    void begin() {}
    void beginTransmission(uint8_t) { sent = 0; }
    void write(uint8_t) { sent++; }
    int endTransmission() { return sent == 3 ? 0 : 1; }
    int requestFrom(uint8_t, uint8_t n) { at = 0; return n; }
    int read() {
        const float share = applied_kPa / 34.474f;
        const uint32_t p = (uint32_t)std::lround(std::min(16777215.0, 1677721.6 + 13421772.8 * share)), t = 5872025;
        const uint8_t all[7] = {0x40, (uint8_t)(p >> 16), (uint8_t)(p >> 8), (uint8_t)p, (uint8_t)(t >> 16), (uint8_t)(t >> 8), (uint8_t)t};
        return all[at++];
    }
};
static Bus Wire;
