#pragma once
#include <cstdint>
#include <cstdio>
#include <cmath>
static const int A0 = 14;
struct Stub {
    void begin(long) {}
    void print(const char *t) { std::fputs(t, stdout); }
    void print(float v, int n) { std::printf("%.*f", n, (double)v); }
    void print(int v) { std::printf("%d", v); }
    void println(const char *t) { std::puts(t); }
    void println(int v) { std::printf("%d\n", v); }
    int available() { return 0; }
    int read() { return -1; }
};
static Stub Serial;
static unsigned long clock_ms = 0;
static float applied_kPa = 0.0f;
static inline unsigned long millis() { return clock_ms; }
static inline void delay(unsigned long ms) { clock_ms += ms; }
int analogRead(int);
