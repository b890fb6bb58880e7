/* Written by tools/effects --flash: bytes of the kernels on a Cortex-M4F, in float. */
/* clang-format off */
static const uint16_t cart_pole_seed[128] = {
    660,688,716,712,2780,2824,2838,2846,684,712,724,720,2816,2842,2846,2854,752,796,832,836,2874,2902,2918,
    2926,0,0,0,0,0,0,0,0,784,780,812,812,2888,2896,2912,2920,812,812,824,824,2908,2916,2920,2928,880,884,916,
    920,2990,3006,3022,3030,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_euler[128] = {
    664,700,744,756,2808,2840,2858,2866,700,736,752,764,2838,2876,2866,2874,788,840,888,904,2930,2962,2998,
    3006,0,0,0,0,0,0,0,0,812,820,844,852,2936,2944,2968,2972,836,844,852,860,2960,2954,2976,2984,936,952,
    1000,1008,3086,3094,3122,3158,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_leap[128] = {
    680,716,780,784,2362,2394,2450,2458,724,764,788,792,2398,2438,2458,2462,860,908,972,980,2510,2544,2602,
    2606,0,0,0,0,0,0,0,0,840,848,876,892,2518,2526,2552,2562,868,876,884,900,2544,2552,2562,2568,1024,1040,
    1080,1088,2658,2666,2694,2702,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t cart_pole_rk4[128] = {
    2268,2354,2438,2454,3966,4086,4178,4206,2312,2410,2446,2462,4054,4166,4182,4210,2602,2764,2848,2854,4334,
    4420,4480,4504,0,0,0,0,0,0,0,0,2650,2678,2704,2730,4400,4416,4464,4480,2722,2748,2712,2738,4468,4494,
    4468,4492,3012,3056,3082,3102,4736,4754,4792,4814,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
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
    276,592,300,616,1982,2286,2006,2314,296,616,308,624,2002,2310,2014,2322,368,684,388,708,2072,2378,2094,
    2402,0,0,0,0,0,0,0,0,364,660,388,696,2066,2364,2088,2392,384,676,396,700,2084,2384,2096,2400,460,780,488,
    804,2176,2466,2200,2490,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_euler[128] = {
    276,592,300,620,1974,2278,1998,2306,296,616,308,628,1994,2302,2006,2314,384,700,408,736,2072,2382,2094,
    2400,0,0,0,0,0,0,0,0,452,744,480,780,2132,2436,2156,2464,476,776,488,788,2156,2460,2168,2472,572,872,600,
    912,2244,2550,2272,2574,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_leap[128] = {
    288,612,312,636,1994,2310,2018,2334,308,636,320,644,2014,2330,2028,2342,408,752,436,792,2110,2420,2134,
    2444,0,0,0,0,0,0,0,0,464,772,492,800,2152,2468,2176,2492,488,796,500,808,2176,2488,2188,2500,624,928,652,
    968,2300,2592,2322,2618,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t reaction_wheel_rk4[128] = {
    360,1944,500,2048,2066,3630,2204,3742,472,2008,508,2056,2176,3710,2212,3754,628,2296,784,2420,2330,3958,
    2442,4054,0,0,0,0,0,0,0,0,696,2236,836,2336,2394,3938,2482,4102,780,2288,840,2340,2438,4062,2486,4114,
    1068,2546,1160,2686,2716,4290,2808,4388,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
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
    336,1984,340,1988,2100,3762,2104,3766,340,1988,340,1988,2104,3766,2104,3766,524,2252,528,2256,2236,4034,
    2240,4038,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,
};
static const uint16_t reaction_wheel_expo8[128] = {
    340,7848,340,7852,0,0,0,0,340,7852,340,7852,0,0,0,0,528,8152,528,8156,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_seed[32] = {
    138,464,150,476,348,660,364,672,184,500,196,512,416,732,428,744,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_euler[32] = {
    130,456,150,476,340,652,360,672,192,508,208,524,416,732,436,752,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_leap[32] = {
    138,472,166,500,348,672,364,712,200,524,224,552,432,756,452,816,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t pendulum_rk4[32] = {
    182,1562,246,1608,404,1814,456,1858,358,1724,394,1768,548,1984,584,2032,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
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
    138,508,150,520,348,704,364,744,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_euler[16] = {
    130,500,150,520,340,692,360,740,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_leap[16] = {
    138,516,166,556,348,712,364,768,0,0,0,0,0,0,0,0,
};
static const uint16_t particle_pendulum_rk4[16] = {
    182,1800,246,1852,404,2060,456,2104,0,0,0,0,0,0,0,0,
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
    4588,4536,4750,4728,4678,4632,4828,4778,4700,4672,4822,4814,4820,4768,4912,4874,4644,4596,4846,4794,4722,
    4694,4888,4842,4760,4732,4906,4894,4880,4832,5032,4950,
};
static const uint16_t rotating_frame_euler[32] = {
    4552,4516,4710,4678,4648,4612,4802,4740,4872,4838,5012,4972,4970,4934,5114,5032,4612,4576,4814,4750,4686,
    4670,4848,4798,4956,4922,5096,5056,5054,5018,5198,5116,
};
static const uint16_t rotating_frame_leap[32] = {
    4584,4566,4794,4764,4694,4688,4888,4846,4924,4878,5092,5052,5026,5034,5142,5112,4672,4658,4900,4850,4732,
    4776,4932,4894,5078,5026,5176,5148,5106,5134,5226,5200,
};
static const uint16_t rotating_frame_rk4[32] = {
    6808,6478,7522,7418,7440,7188,7760,7698,7232,7230,7936,7790,7712,7570,8168,8026,7284,6956,7846,7730,7660,
    7474,7998,7932,7600,7476,8276,8124,7952,7896,8420,8352,
};
static const uint16_t rotating_frame_expo[32] = {
    0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,7816,7702,0,0,
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
    138,508,150,520,348,704,364,744,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_euler[16] = {
    130,500,150,520,340,692,360,740,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_leap[16] = {
    138,516,166,556,348,712,364,768,0,0,0,0,0,0,0,0,
};
static const uint16_t fixed_axis_rk4[16] = {
    182,1800,246,1852,404,2060,456,2104,0,0,0,0,0,0,0,0,
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
    138,468,150,480,348,660,364,672,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_euler[16] = {
    130,456,150,480,340,652,360,672,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_leap[16] = {
    138,476,166,504,348,672,364,712,0,0,0,0,0,0,0,0,
};
static const uint16_t solid_pendulum_rk4[16] = {
    182,1570,246,1616,404,1820,456,1864,0,0,0,0,0,0,0,0,
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
    1476,
};
static const uint16_t block_seed[32] = {
    138,146,364,372,150,184,372,380,624,628,824,828,636,640,836,840,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_euler[32] = {
    126,134,376,384,138,146,368,380,632,640,836,840,624,628,848,852,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_leap[32] = {
    134,142,368,376,154,188,380,392,656,664,840,844,684,692,880,884,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_rk4[32] = {
    182,190,404,412,288,296,492,500,1752,1756,1980,1984,1844,1848,2076,2080,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,
};
static const uint16_t block_expo[32] = {
    1404,1378,1604,1584,1400,1400,1604,1612,1884,1884,2084,2092,1932,1940,2140,2148,3578,3586,0,0,3646,3654,
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
    154,162,772,780,158,166,764,772,162,170,780,788,166,174,772,780,
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
