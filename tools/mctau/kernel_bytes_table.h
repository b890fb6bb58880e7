/* Written by tools/effects --flash: bytes of the kernels on a Cortex-M4F, in float. */
/* clang-format off */
static const uint16_t cart_pole_seed[128] = {
    660,688,716,712,2792,2836,2850,2858,684,712,724,720,2828,2854,2858,2866,752,796,832,836,2886,2914,2930,
    2938,0,0,0,0,0,0,0,0,784,780,812,812,2900,2908,2924,2932,812,812,824,824,2920,2928,2932,2940,880,884,916,
    920,3002,3018,3034,3042,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_euler[128] = {
    664,700,744,756,2820,2852,2870,2878,700,736,752,764,2850,2888,2878,2886,788,840,888,904,2942,2974,3010,
    3018,0,0,0,0,0,0,0,0,812,820,844,852,2948,2956,2980,2984,836,844,852,860,2972,2966,2988,2996,936,952,
    1000,1008,3098,3106,3134,3170,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_leap[128] = {
    680,716,780,784,2374,2406,2462,2470,724,764,788,792,2410,2450,2470,2474,860,908,972,980,2522,2556,2614,
    2618,0,0,0,0,0,0,0,0,840,848,876,892,2530,2538,2564,2574,868,876,884,900,2556,2564,2574,2580,1024,1040,
    1080,1088,2670,2678,2706,2714,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_rk4[128] = {
    2268,2354,2438,2454,3978,4098,4190,4218,2312,2410,2446,2462,4066,4178,4194,4222,2602,2764,2848,2854,4346,
    4432,4492,4516,0,0,0,0,0,0,0,0,2650,2678,2704,2730,4412,4428,4476,4492,2722,2748,2712,2738,4480,4506,
    4480,4504,3012,3056,3082,3102,4748,4766,4804,4826,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_taylor4[128] = {
    1452,1498,1512,1560,0,0,0,0,1522,1522,1520,1568,0,0,0,0,1750,1784,1820,1876,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_taylor6[128] = {
    2100,2200,2192,2308,0,0,0,0,2184,2220,2200,2316,0,0,0,0,2516,2544,2620,2720,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,5344,5416,5436,5540,0,0,0,0,5444,5480,5456,
    5560,0,0,0,0,5936,5952,6054,6158,0,0,0,0,0,0,0,0,0,0,0,0,5770,5890,5906,6074,0,0,0,0,5886,5982,5926,6078,
    0,0,0,0,6450,6538,6632,6694,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_taylor8[128] = {
    2864,2996,2984,3128,0,0,0,0,2980,3040,2988,3136,0,0,0,0,3472,3492,3556,3692,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_taylor12[128] = {
    4936,5148,5124,5380,0,0,0,0,5116,5216,5124,5396,0,0,0,0,5836,5920,6008,6260,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_seed[128] = {
    276,592,300,616,1994,2298,2018,2326,296,616,308,624,2014,2322,2026,2334,368,684,388,708,2084,2390,2106,
    2414,0,0,0,0,0,0,0,0,364,660,388,696,2078,2376,2100,2404,384,676,396,700,2096,2396,2108,2412,460,780,488,
    804,2188,2478,2212,2502,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_euler[128] = {
    276,592,300,620,1986,2290,2010,2318,296,616,308,628,2006,2314,2018,2326,384,700,408,736,2084,2394,2106,
    2412,0,0,0,0,0,0,0,0,452,744,480,780,2144,2448,2168,2476,476,776,488,788,2168,2472,2180,2484,572,872,600,
    912,2256,2562,2284,2586,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_leap[128] = {
    288,612,312,636,2006,2322,2030,2346,308,636,320,644,2026,2342,2040,2354,408,752,436,792,2122,2432,2146,
    2456,0,0,0,0,0,0,0,0,464,772,492,800,2164,2480,2188,2504,488,796,500,808,2188,2500,2200,2512,624,928,652,
    968,2312,2604,2334,2630,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_rk4[128] = {
    360,1944,500,2048,2078,3642,2216,3754,472,2008,508,2056,2188,3722,2224,3766,628,2296,784,2420,2342,3970,
    2454,4066,0,0,0,0,0,0,0,0,696,2236,836,2336,2406,3950,2494,4114,780,2288,840,2340,2450,4074,2498,4126,
    1068,2546,1160,2686,2728,4302,2820,4400,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_taylor4[128] = {
    452,972,548,1044,0,0,0,0,528,1016,556,1060,0,0,0,0,744,1200,824,1302,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_taylor6[128] = {
    564,1308,768,1426,0,0,0,0,736,1366,780,1434,0,0,0,0,992,1670,1140,1816,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,3986,4756,4122,4802,0,0,0,0,4050,4780,4130,4810,0,
    0,0,0,4446,5188,4566,5360,0,0,0,0,0,0,0,0,0,0,0,0,4364,5092,4482,5216,0,0,0,0,4454,5144,4490,5224,0,0,0,
    0,4910,5608,5040,5776,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_taylor8[128] = {
    712,1768,980,1952,0,0,0,0,972,1872,992,1960,0,0,0,0,1268,2244,1448,2420,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_taylor12[128] = {
    936,2936,1432,3180,0,0,0,0,1460,3080,1436,3188,0,0,0,0,1888,3636,2108,3880,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_expo[128] = {
    336,1988,340,1992,2112,3778,2116,3782,340,1992,340,1992,2116,3782,2116,3782,524,2252,528,2256,2248,4046,
    2252,4050,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,
};
static const uint16_t reaction_wheel_expo8[128] = {
    340,7936,340,7940,0,0,0,0,340,7940,340,7940,0,0,0,0,528,8238,528,8242,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_seed[32] = {
    138,464,150,476,352,664,364,676,184,500,196,512,420,732,432,744,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_euler[32] = {
    130,456,150,476,344,652,360,672,192,508,208,524,420,732,440,752,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_leap[32] = {
    138,472,166,500,352,676,368,708,200,524,224,552,436,756,456,812,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_rk4[32] = {
    182,1562,246,1608,408,1810,456,1854,358,1724,394,1768,548,1980,584,2028,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_taylor4[32] = {
    138,716,260,776,0,0,0,0,0,0,0,0,0,0,0,0,2706,3356,2834,3424,0,0,0,0,2888,3478,2974,3514,0,0,0,0,
};
static const uint16_t pendulum_taylor6[32] = {
    138,944,324,1064,0,0,0,0,0,0,0,0,0,0,0,0,2730,3614,2970,3722,0,0,0,0,3082,3842,3140,3938,0,0,0,0,
};
static const uint16_t pendulum_taylor8[32] = {
    138,1308,384,1470,0,0,0,0,0,0,0,0,0,0,0,0,2770,3994,3072,4110,0,0,0,0,3260,4274,3340,4442,0,0,0,0,
};
static const uint16_t pendulum_taylor12[32] = {
    138,2316,624,2556,0,0,0,0,0,0,0,0,0,0,0,0,2744,4906,3314,5132,0,0,0,0,3758,5652,3846,5838,0,0,0,0,
};
static const uint16_t pendulum_rkn6[32] = {
    256,2518,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t spring_pendulum_seed[8] = {
    512,864,552,912,532,892,568,932,
};
static const uint16_t spring_pendulum_euler[8] = {
    1456,1832,1632,2000,1526,1900,1720,2080,
};
static const uint16_t spring_pendulum_leap[8] = {
    1716,2096,1920,2300,1800,2160,1984,2344,
};
static const uint16_t spring_pendulum_rk4[8] = {
    2520,2880,2836,3300,5444,7150,5548,7276,
};
static const uint16_t spring_pendulum_taylor4[8] = {
    5706,6138,6284,6644,8218,8732,8278,8844,
};
static const uint16_t spring_pendulum_taylor6[8] = {
    5972,6406,6772,7108,8662,9480,8750,9628,
};
static const uint16_t spring_pendulum_taylor8[8] = {
    6244,6674,7236,7572,9216,10562,9332,10730,
};
static const uint16_t spring_pendulum_taylor12[8] = {
    6780,7206,8220,8570,7442,7794,8428,8682,
};
static const uint16_t spring_pendulum_split3[8] = {
    404,1482,460,1580,476,1600,544,1676,
};
static const uint16_t linked_particles_seed[2] = {
    138,146,
};
static const uint16_t linked_particles_euler[2] = {
    130,138,
};
static const uint16_t linked_particles_leap[2] = {
    138,146,
};
static const uint16_t linked_particles_rk4[2] = {
    182,190,
};
static const uint16_t particle_pendulum_seed[16] = {
    138,508,150,520,352,704,364,740,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_euler[16] = {
    130,500,150,520,344,692,360,736,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_leap[16] = {
    138,516,166,556,352,712,368,764,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_rk4[16] = {
    182,1800,246,1852,408,2056,456,2100,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_taylor4[16] = {
    138,796,260,848,0,0,0,0,2706,3452,2834,3514,0,0,0,0,
};
static const uint16_t particle_pendulum_taylor6[16] = {
    138,1124,324,1256,0,0,0,0,2730,3770,2970,3858,0,0,0,0,
};
static const uint16_t particle_pendulum_taylor8[16] = {
    138,1544,384,1716,0,0,0,0,2770,4114,3072,4250,0,0,0,0,
};
static const uint16_t particle_pendulum_taylor12[16] = {
    138,2640,624,2888,0,0,0,0,2744,5208,3314,5428,0,0,0,0,
};
static const uint16_t particle_pendulum_rkn6[16] = {
    256,2834,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t moving_base_seed[8] = {
    138,464,150,476,1020,1060,1060,1080,
};
static const uint16_t moving_base_euler[8] = {
    130,456,150,476,992,1040,1048,1068,
};
static const uint16_t moving_base_leap[8] = {
    138,472,166,500,1004,1056,1056,1076,
};
static const uint16_t moving_base_rk4[8] = {
    182,1562,246,1608,3420,3496,3522,3570,
};
static const uint16_t moving_base_taylor4[8] = {
    232,744,300,768,1714,1758,1758,1794,
};
static const uint16_t moving_base_taylor6[8] = {
    288,968,384,1028,2388,2442,2464,2506,
};
static const uint16_t moving_base_taylor8[8] = {
    368,1298,448,1380,3260,3344,3304,3420,
};
static const uint16_t moving_base_taylor12[8] = {
    484,2308,728,2440,5704,5910,5940,6048,
};
static const uint16_t rotating_frame_seed[32] = {
    2798,2746,2932,2914,2888,2842,3014,2964,2910,2882,3010,2998,3030,2978,3088,3058,2854,2806,3032,2980,2932,
    2904,3074,3036,2970,2942,3094,3078,3090,3042,3212,3134,
};
static const uint16_t rotating_frame_euler[32] = {
    2762,2726,2896,2864,2858,2822,2988,2924,3082,3048,3194,3150,3180,3144,3292,3210,2822,2786,3000,2936,2896,
    2880,3034,2984,3166,3132,3278,3234,3264,3228,3376,3294,
};
static const uint16_t rotating_frame_leap[32] = {
    2794,2780,2978,2950,2904,2890,3090,3044,3150,3088,3270,3238,3236,3256,3322,3306,2882,2868,3086,3048,2942,
    2986,3118,3092,3276,3236,3358,3338,3316,3344,3406,3390,
};
static const uint16_t rotating_frame_rk4[32] = {
    5018,4688,5636,5526,5650,5398,5870,5806,5418,5440,6046,5908,5922,5780,6286,6146,5462,5166,5952,5838,5870,
    5688,6106,6044,5810,5686,6390,6242,6162,6106,6590,6472,
};
static const uint16_t rotating_frame_expo[32] = {
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,6026,5912,0,0,
};
static const uint16_t ball_joint_seed[4] = {
    2696,2914,2736,2956,
};
static const uint16_t ball_joint_euler[4] = {
    2852,3072,2876,3112,
};
static const uint16_t ball_joint_leap[4] = {
    3742,3998,3882,4126,
};
static const uint16_t ball_joint_rk4[4] = {
    3428,4294,3492,4364,
};
static const uint16_t ball_joint_taylor4[4] = {
    2326,2808,2386,2860,
};
static const uint16_t ball_joint_taylor6[4] = {
    2330,2808,2390,2860,
};
static const uint16_t ball_joint_taylor8[4] = {
    2330,2808,2390,2860,
};
static const uint16_t ball_joint_taylor12[4] = {
    2330,2808,2390,2860,
};
static const uint16_t ball_joint_split3[4] = {
    5404,5916,5540,6040,
};
static const uint16_t fixed_axis_seed[16] = {
    138,508,150,520,352,704,364,740,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_euler[16] = {
    130,500,150,520,344,692,360,736,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_leap[16] = {
    138,516,166,556,352,712,368,764,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_rk4[16] = {
    182,1800,246,1852,408,2056,456,2100,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_taylor4[16] = {
    138,796,260,848,0,0,0,0,2706,3452,2834,3514,0,0,0,0,
};
static const uint16_t fixed_axis_taylor6[16] = {
    138,1124,324,1256,0,0,0,0,2730,3770,2970,3858,0,0,0,0,
};
static const uint16_t fixed_axis_taylor8[16] = {
    138,1544,384,1716,0,0,0,0,2770,4114,3072,4250,0,0,0,0,
};
static const uint16_t fixed_axis_taylor12[16] = {
    138,2640,624,2888,0,0,0,0,2744,5208,3314,5428,0,0,0,0,
};
static const uint16_t fixed_axis_rkn6[16] = {
    256,2834,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_seed[16] = {
    138,468,150,480,352,664,364,676,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_euler[16] = {
    130,456,150,480,344,652,360,672,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_leap[16] = {
    138,476,166,504,352,676,368,708,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_rk4[16] = {
    182,1570,246,1616,408,1816,456,1860,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_taylor4[16] = {
    138,716,260,768,0,0,0,0,2706,3328,2834,3420,0,0,0,0,
};
static const uint16_t solid_pendulum_taylor6[16] = {
    138,940,324,1052,0,0,0,0,2730,3602,2970,3722,0,0,0,0,
};
static const uint16_t solid_pendulum_taylor8[16] = {
    138,1302,384,1470,0,0,0,0,2770,3986,3072,4098,0,0,0,0,
};
static const uint16_t solid_pendulum_taylor12[16] = {
    138,2308,624,2548,0,0,0,0,2744,4942,3314,5112,0,0,0,0,
};
static const uint16_t solid_pendulum_rkn6[16] = {
    256,2528,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t rigid_body_seed[8] = {
    2860,2900,3148,3196,3356,3372,3664,3668,
};
static const uint16_t rigid_body_euler[8] = {
    2920,2988,3260,3296,3468,3488,3788,3804,
};
static const uint16_t rigid_body_leap[8] = {
    3918,3974,4450,4502,4458,4490,5034,5050,
};
static const uint16_t rigid_body_rk4[8] = {
    3272,3226,5310,5474,6214,6190,7326,7282,
};
static const uint16_t rigid_body_taylor4[8] = {
    3948,4086,0,0,3586,3604,0,0,
};
static const uint16_t rigid_body_taylor6[8] = {
    3952,4060,0,0,3636,3652,0,0,
};
static const uint16_t rigid_body_taylor8[8] = {
    3952,4060,0,0,3680,3698,0,0,
};
static const uint16_t rigid_body_taylor12[8] = {
    3952,4060,0,0,3782,3800,0,0,
};
static const uint16_t rigid_body_split3[8] = {
    5660,5724,0,0,6680,6684,0,0,
};
static const uint16_t chain_discrete[1] = {
    1468,
};
static const uint16_t block_seed[32] = {
    138,146,368,376,150,184,376,388,624,628,828,832,636,640,840,844,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_euler[32] = {
    126,134,376,384,138,146,372,384,632,640,840,844,624,628,852,856,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_leap[32] = {
    134,142,368,376,154,188,384,396,656,664,844,848,684,692,884,888,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_rk4[32] = {
    182,190,416,424,288,296,496,504,1752,1756,1988,1992,1844,1848,2080,2084,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_expo[32] = {
    1404,1378,1608,1588,1400,1400,1608,1616,1884,1884,2088,2096,1932,1940,2144,2152,3578,3586,0,0,3646,3654,
    0,0,4218,4226,0,0,4310,4318,0,0,
};
static const uint16_t falling_sphere_seed[16] = {
    138,146,184,192,150,158,196,204,146,154,192,200,158,166,204,212,
};
static const uint16_t falling_sphere_euler[16] = {
    130,138,208,216,172,180,224,232,138,146,216,224,180,188,232,240,
};
static const uint16_t falling_sphere_leap[16] = {
    138,146,216,224,212,220,260,268,146,154,224,232,220,204,268,276,
};
static const uint16_t falling_sphere_rk4[16] = {
    182,190,344,352,256,264,386,394,190,198,352,360,264,272,394,402,
};
static const uint16_t falling_sphere_expo[16] = {
    154,162,764,772,158,166,764,772,162,170,772,780,166,174,772,780,
};
static const measured_system measured_systems[MCT_SYSTEM_COUNT] = {
    {0x1005f, {
        [MCT_STEPPER_SEED] = cart_pole_seed,
        [MCT_STEPPER_EULER] = cart_pole_euler,
        [MCT_STEPPER_LEAP] = cart_pole_leap,
        [MCT_STEPPER_RK4] = cart_pole_rk4,
        [MCT_STEPPER_TAYLOR4] = cart_pole_taylor4,
        [MCT_STEPPER_TAYLOR6] = cart_pole_taylor6,
        [MCT_STEPPER_TAYLOR8] = cart_pole_taylor8,
        [MCT_STEPPER_TAYLOR12] = cart_pole_taylor12,
    }},
    {0x1005f, {
        [MCT_STEPPER_SEED] = reaction_wheel_seed,
        [MCT_STEPPER_EULER] = reaction_wheel_euler,
        [MCT_STEPPER_LEAP] = reaction_wheel_leap,
        [MCT_STEPPER_RK4] = reaction_wheel_rk4,
        [MCT_STEPPER_TAYLOR4] = reaction_wheel_taylor4,
        [MCT_STEPPER_TAYLOR6] = reaction_wheel_taylor6,
        [MCT_STEPPER_TAYLOR8] = reaction_wheel_taylor8,
        [MCT_STEPPER_TAYLOR12] = reaction_wheel_taylor12,
        [MCT_STEPPER_EXPO] = reaction_wheel_expo,
        [MCT_STEPPER_EXPO8] = reaction_wheel_expo8,
    }},
    {0x10047, {
        [MCT_STEPPER_SEED] = pendulum_seed,
        [MCT_STEPPER_EULER] = pendulum_euler,
        [MCT_STEPPER_LEAP] = pendulum_leap,
        [MCT_STEPPER_RK4] = pendulum_rk4,
        [MCT_STEPPER_TAYLOR4] = pendulum_taylor4,
        [MCT_STEPPER_TAYLOR6] = pendulum_taylor6,
        [MCT_STEPPER_TAYLOR8] = pendulum_taylor8,
        [MCT_STEPPER_TAYLOR12] = pendulum_taylor12,
        [MCT_STEPPER_RKN6] = pendulum_rkn6,
    }},
    {0x83, {
        [MCT_STEPPER_SEED] = spring_pendulum_seed,
        [MCT_STEPPER_EULER] = spring_pendulum_euler,
        [MCT_STEPPER_LEAP] = spring_pendulum_leap,
        [MCT_STEPPER_RK4] = spring_pendulum_rk4,
        [MCT_STEPPER_TAYLOR4] = spring_pendulum_taylor4,
        [MCT_STEPPER_TAYLOR6] = spring_pendulum_taylor6,
        [MCT_STEPPER_TAYLOR8] = spring_pendulum_taylor8,
        [MCT_STEPPER_TAYLOR12] = spring_pendulum_taylor12,
        [MCT_STEPPER_SPLIT3] = spring_pendulum_split3,
    }},
    {0x8000, {
        [MCT_STEPPER_SEED] = linked_particles_seed,
        [MCT_STEPPER_EULER] = linked_particles_euler,
        [MCT_STEPPER_LEAP] = linked_particles_leap,
        [MCT_STEPPER_RK4] = linked_particles_rk4,
    }},
    {0x10007, {
        [MCT_STEPPER_SEED] = particle_pendulum_seed,
        [MCT_STEPPER_EULER] = particle_pendulum_euler,
        [MCT_STEPPER_LEAP] = particle_pendulum_leap,
        [MCT_STEPPER_RK4] = particle_pendulum_rk4,
        [MCT_STEPPER_TAYLOR4] = particle_pendulum_taylor4,
        [MCT_STEPPER_TAYLOR6] = particle_pendulum_taylor6,
        [MCT_STEPPER_TAYLOR8] = particle_pendulum_taylor8,
        [MCT_STEPPER_TAYLOR12] = particle_pendulum_taylor12,
        [MCT_STEPPER_RKN6] = particle_pendulum_rkn6,
    }},
    {0x103, {
        [MCT_STEPPER_SEED] = moving_base_seed,
        [MCT_STEPPER_EULER] = moving_base_euler,
        [MCT_STEPPER_LEAP] = moving_base_leap,
        [MCT_STEPPER_RK4] = moving_base_rk4,
        [MCT_STEPPER_TAYLOR4] = moving_base_taylor4,
        [MCT_STEPPER_TAYLOR6] = moving_base_taylor6,
        [MCT_STEPPER_TAYLOR8] = moving_base_taylor8,
        [MCT_STEPPER_TAYLOR12] = moving_base_taylor12,
    }},
    {0xe41, {
        [MCT_STEPPER_SEED] = rotating_frame_seed,
        [MCT_STEPPER_EULER] = rotating_frame_euler,
        [MCT_STEPPER_LEAP] = rotating_frame_leap,
        [MCT_STEPPER_RK4] = rotating_frame_rk4,
        [MCT_STEPPER_EXPO] = rotating_frame_expo,
    }},
    {0x3, {
        [MCT_STEPPER_SEED] = ball_joint_seed,
        [MCT_STEPPER_EULER] = ball_joint_euler,
        [MCT_STEPPER_LEAP] = ball_joint_leap,
        [MCT_STEPPER_RK4] = ball_joint_rk4,
        [MCT_STEPPER_TAYLOR4] = ball_joint_taylor4,
        [MCT_STEPPER_TAYLOR6] = ball_joint_taylor6,
        [MCT_STEPPER_TAYLOR8] = ball_joint_taylor8,
        [MCT_STEPPER_TAYLOR12] = ball_joint_taylor12,
        [MCT_STEPPER_SPLIT3] = ball_joint_split3,
    }},
    {0x10007, {
        [MCT_STEPPER_SEED] = fixed_axis_seed,
        [MCT_STEPPER_EULER] = fixed_axis_euler,
        [MCT_STEPPER_LEAP] = fixed_axis_leap,
        [MCT_STEPPER_RK4] = fixed_axis_rk4,
        [MCT_STEPPER_TAYLOR4] = fixed_axis_taylor4,
        [MCT_STEPPER_TAYLOR6] = fixed_axis_taylor6,
        [MCT_STEPPER_TAYLOR8] = fixed_axis_taylor8,
        [MCT_STEPPER_TAYLOR12] = fixed_axis_taylor12,
        [MCT_STEPPER_RKN6] = fixed_axis_rkn6,
    }},
    {0x10007, {
        [MCT_STEPPER_SEED] = solid_pendulum_seed,
        [MCT_STEPPER_EULER] = solid_pendulum_euler,
        [MCT_STEPPER_LEAP] = solid_pendulum_leap,
        [MCT_STEPPER_RK4] = solid_pendulum_rk4,
        [MCT_STEPPER_TAYLOR4] = solid_pendulum_taylor4,
        [MCT_STEPPER_TAYLOR6] = solid_pendulum_taylor6,
        [MCT_STEPPER_TAYLOR8] = solid_pendulum_taylor8,
        [MCT_STEPPER_TAYLOR12] = solid_pendulum_taylor12,
        [MCT_STEPPER_RKN6] = solid_pendulum_rkn6,
    }},
    {0x8041, {
        [MCT_STEPPER_SEED] = rigid_body_seed,
        [MCT_STEPPER_EULER] = rigid_body_euler,
        [MCT_STEPPER_LEAP] = rigid_body_leap,
        [MCT_STEPPER_RK4] = rigid_body_rk4,
        [MCT_STEPPER_TAYLOR4] = rigid_body_taylor4,
        [MCT_STEPPER_TAYLOR6] = rigid_body_taylor6,
        [MCT_STEPPER_TAYLOR8] = rigid_body_taylor8,
        [MCT_STEPPER_TAYLOR12] = rigid_body_taylor12,
        [MCT_STEPPER_SPLIT3] = rigid_body_split3,
    }},
    {0x0, {
        [MCT_STEPPER_DISCRETE] = chain_discrete,
    }},
    {0x14085, {
        [MCT_STEPPER_SEED] = block_seed,
        [MCT_STEPPER_EULER] = block_euler,
        [MCT_STEPPER_LEAP] = block_leap,
        [MCT_STEPPER_RK4] = block_rk4,
        [MCT_STEPPER_EXPO] = block_expo,
    }},
    {0x3041, {
        [MCT_STEPPER_SEED] = falling_sphere_seed,
        [MCT_STEPPER_EULER] = falling_sphere_euler,
        [MCT_STEPPER_LEAP] = falling_sphere_leap,
        [MCT_STEPPER_RK4] = falling_sphere_rk4,
        [MCT_STEPPER_EXPO] = falling_sphere_expo,
    }},
};
