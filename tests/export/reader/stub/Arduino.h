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
    void write(uint8_t c) { std::putchar(c); }
    int available() { return sent != 0; }
    int read() { int c = sent; sent = 0; return c; }
    int sent = 0;
};
static Stub Serial;
static unsigned long clock_ms = 0;
static float applied_kPa = 0.0f;
static inline unsigned long millis() { return clock_ms; }
static inline void delay(unsigned long ms) { clock_ms += ms; }
int analogRead(int);
