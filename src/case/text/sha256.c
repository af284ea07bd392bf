/* SPDX-License-Identifier: BSD-3-Clause */
#include "sha256.h"
#include <stdint.h>
#include <string.h>

enum { BLOCK = 64, ROUNDS = 64, WORDS = 8 };

static const uint32_t constants[ROUNDS] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static const uint32_t beginning[WORDS] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                          0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

static uint32_t turned(uint32_t x, int by)
{
    return x >> by | x << (32 - by);
}

static void add_block(uint32_t state[WORDS], const unsigned char *block)
{
    uint32_t w[ROUNDS], s[WORDS];
    for (int k = 0; k < 16; k++)
        w[k] = (uint32_t)block[4 * k] << 24 | (uint32_t)block[4 * k + 1] << 16 |
               (uint32_t)block[4 * k + 2] << 8 | block[4 * k + 3];
    for (int k = 16; k < ROUNDS; k++)
        w[k] = w[k - 16] + w[k - 7] +
               (turned(w[k - 15], 7) ^ turned(w[k - 15], 18) ^ w[k - 15] >> 3) +
               (turned(w[k - 2], 17) ^ turned(w[k - 2], 19) ^ w[k - 2] >> 10);
    memcpy(s, state, sizeof s);
    for (int k = 0; k < ROUNDS; k++) {
        const uint32_t first = s[7] + (turned(s[4], 6) ^ turned(s[4], 11) ^ turned(s[4], 25)) +
                               ((s[4] & s[5]) ^ (~s[4] & s[6])) + constants[k] + w[k];
        const uint32_t second = (turned(s[0], 2) ^ turned(s[0], 13) ^ turned(s[0], 22)) +
                                ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
        memmove(s + 1, s, (WORDS - 1) * sizeof *s);
        s[4] += first;
        s[0] = first + second;
    }
    for (int k = 0; k < WORDS; k++) state[k] += s[k];
}

bool mps__sha256(FILE *file, char out[SHA256_TEXT])
{
    unsigned char block[2 * BLOCK];
    uint32_t state[WORDS];
    uint64_t bytes = 0;
    size_t got;
    memcpy(state, beginning, sizeof state);
    while ((got = fread(block, 1, BLOCK, file)) == BLOCK) {
        add_block(state, block);
        bytes += BLOCK;
    }
    if (ferror(file)) return false;
    bytes += got;
    memset(block + got, 0, sizeof block - got);
    block[got] = 0x80;
    const size_t end = got < BLOCK - 8 ? BLOCK : 2 * BLOCK;
    for (int k = 0; k < 8; k++) block[end - 1 - (size_t)k] = (unsigned char)(8 * bytes >> 8 * k);
    for (size_t at = 0; at < end; at += BLOCK) add_block(state, block + at);
    for (int k = 0; k < WORDS; k++) snprintf(out + 8 * k, 9, "%08x", (unsigned)state[k]);
    return true;
}
