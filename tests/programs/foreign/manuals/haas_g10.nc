G10 L2 P1 G91 X6.0 {Move coordinate G54 6.0 to the right};
G10 L20 P2 G90 X10. Y8. {Set work coordinate G111 to X10.0 ,Y8.0};
G10 L10 G90 P5 R2.5 {Set offset for Tool #5 to 2.5};
G10 L12 G90 P5 R.375 {Set diameter for Tool #5 to .375”};
G10 L20 P50 G90 X10. Y20. {Set work coordinate G154 P50 to X10. Y20.}
