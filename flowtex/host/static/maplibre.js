// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
function Fa(a){let e=a>>10&31,t=a&1023,r;return e===0?r=t*2**-24:e===31?r=t?NaN:1/0:r=(1024+t)*2**(e-25),a&32768?-r:r}var Le=Float32Array.
from({length:65536},(a,e)=>Fa(e)),zr=new Float32Array(1),Hr=new Uint32Array(zr.buffer);function Gr(a){zr[0]=a;let e=Hr[0]>>>
16&32768,t=Hr[0]&2147483647;return t>=1199566848?e|(t>2139095040?32256:31744):t<947912704?e|Math.round(Math.abs(a)*2**24):
e|t-93952e4>>>13}function cr(a,e,t,r=1){let n=a.getParameter(a.MAX_TEXTURE_SIZE),s=a.getParameter(a.MAX_ARRAY_TEXTURE_LAYERS);
if(Math.max(e,t)>n||r>s)throw new Error(`a texture of ${e} x ${t} texels in ${r} layers is needed, but this graphics car\
d supports at most ${n} x ${n} in ${s}; show fewer nodes`)}function et(a,e,t){let{width:r,height:n,layers:s,channels:i,levels:o}=t;
cr(a,r,n,s);let c=a.TEXTURE_2D_ARRAY;a.bindTexture(c,e),a.texStorage3D(c,o+1,i===1?a.R16F:a.RGBA16F,r,n,s),a.texParameteri(
c,a.TEXTURE_MIN_FILTER,a.LINEAR_MIPMAP_LINEAR),a.texParameteri(c,a.TEXTURE_MAG_FILTER,a.LINEAR),a.texParameteri(c,a.TEXTURE_WRAP_S,
a.CLAMP_TO_EDGE),a.texParameteri(c,a.TEXTURE_WRAP_T,a.CLAMP_TO_EDGE)}var jr=["coastlines","graticule"],Me={critical:"critical_points",separatrices:"separatrices",nullclines:"nullclines"},tt={
saddle:8,orbit:4,leaving:2},Wr={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,
int8:Int8Array,uint8:Uint8Array};function lr({low:a,high:e,log:t}){if(!t)return n=>(n-a)/(e-a||1);let r=Math.log(e/a)||1;
return n=>Math.log(Math.max(n,a)/a)/r}function me(a){return a.variant.includes("FLOWTEX_SIGNFREE")}function X(a){return Number(a.split("/")[1])}function Ee(a,e,{
scalars:t}){let[r,n,s="0"]=a.split("/"),i=t.choices[Number(s)]?.steps??t.steps;return r==="scalars"&&Number(n)===e&&i>1}
function ue(a){let[e,t,r,n,...s]=a.split("/");return e==="tile"?[[t,r,n].join("/"),s.join("/")]:null}function Yr(a,e){let t=ArrayBuffer.
isView(e)?new Uint8Array(e.buffer,e.byteOffset,e.byteLength):new Uint8Array(e),{name:r,dtype:n,shape:s,digest:i}=a,o=Wr[n];
if(!o)throw new Error(`a part has the type "${n}"; expected ${Object.keys(Wr).join(", ")}`);return{name:r,shape:s,digest:i,
data:new o(t.slice().buffer)}}function Xr(a){let[e,t]=hr(new Uint8Array(a)),r=t;return e.map(n=>{let s=new Uint8Array(a,
r,n.bytes);return r+=n.bytes,n.differences===void 0?Yr(n,s):Kr(n,s)})}function hr(a){let e=4+new DataView(a.buffer,a.byteOffset).
getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(a.subarray(4,e))),e]}async function qr(a,e){return Kr(a,new Uint8Array(
await Na(e).arrayBuffer()))}function Na(a){let e=atob(a),t=new Uint8Array(e.length);for(let r=0;r<t.length;r+=1)t[r]=e.charCodeAt(
r);return new Response(new Blob([t]).stream().pipeThrough(new DecompressionStream("gzip")))}var $r={1:Uint8Array,2:Uint16Array,
4:Uint32Array};function Kr(a,e){let{shape:t,differences:r=[0,0],scale:n=null}=a,s=t.reduce((m,u)=>m*u,1),i=s?e.length/s:
1;if(!(i in $r))throw new Error(`the packing of the part "${a.name}" is invalid`);let[o,c]=t.length>2?t.slice(-2):[...t,
1].slice(-2),l=new $r[i](s);for(let m=0,u=0;m<c;m+=1)for(let p=m;p<s;p+=c,u+=1){let f=0;for(let d=0;d<i;d+=1)f|=e[d*s+u]<<
8*d;l[p]=f>>>1^-(f&1)}let h=o*c;for(let m=0;m<r[0];m+=1)for(let u=h;u<s;u+=1)l[u]+=l[u-h];for(let m=0;m<r[1];m+=1)for(let u=0;u<
s;u+=h)for(let p=u+c;p<u+h;p+=1)l[p]+=l[p-c];return Yr(a,n?Ia(l,n.map(m=>2**m)):l)}function Ia(a,e){let t=e.length;return a instanceof
Uint16Array?a.map((r,n)=>Gr((r<<16>>16)*e[n%t])):new Float32Array(new Float64Array(a).map((r,n)=>(r|0)*e[n%t]))}var mr=1e-6,rt=typeof Float32Array<"u"?Float32Array:Array;var Fc=Math.PI/180,Nc=180/Math.PI;function Zr(a,e){if(a===e){var t=e[1],r=e[2],n=e[5];a[1]=e[3],a[2]=e[6],a[3]=t,a[5]=e[7],a[6]=r,a[7]=n}else a[0]=e[0],a[1]=
e[3],a[2]=e[6],a[3]=e[1],a[4]=e[4],a[5]=e[7],a[6]=e[2],a[7]=e[5],a[8]=e[8];return a}function Qr(a,e,t){var r=t[0],n=t[1],s=t[2],i=Math.sqrt(r*r+n*n+s*s),o,c,l;return i<mr?null:(i=1/i,r*=i,n*=i,s*=i,o=Math.
sin(e),c=Math.cos(e),l=1-c,a[0]=r*r*l+c,a[1]=n*r*l+s*o,a[2]=s*r*l-n*o,a[3]=0,a[4]=r*n*l-s*o,a[5]=n*n*l+c,a[6]=s*n*l+r*o,
a[7]=0,a[8]=r*s*l+n*o,a[9]=n*s*l-r*o,a[10]=s*s*l+c,a[11]=0,a[12]=0,a[13]=0,a[14]=0,a[15]=1,a)}function Va(){var a=new rt(3);return rt!=Float32Array&&(a[0]=0,a[1]=0,a[2]=0),a}function en(a){var e=a[0],t=a[1],r=a[2];return Math.sqrt(e*e+t*t+r*r)}function tn(a,e,t){return a[0]=e[0]-t[0],a[1]=e[1]-t[1],a[2]=e[2]-t[2],a}function rn(a,e,t){return a[0]=e[0]*t,a[1]=e[1]*t,a[2]=e[2]*t,a}function nn(a,e,t,r){return a[0]=e[0]+t[0]*r,a[1]=e[1]+t[1]*
r,a[2]=e[2]+t[2]*r,a}function sn(a,e){var t=e[0],r=e[1],n=e[2],s=t*t+r*r+n*n;return s>0&&(s=1/Math.sqrt(s)),a[0]=e[0]*s,a[1]=e[1]*s,a[2]=e[2]*
s,a}function an(a,e){return a[0]*e[0]+a[1]*e[1]+a[2]*e[2]}function on(a,e,t){var r=e[0],n=e[1],s=e[2],i=t[0],o=t[1],c=t[2];
return a[0]=n*c-s*o,a[1]=s*i-r*c,a[2]=r*o-n*i,a}function cn(a,e,t){var r=e[0],n=e[1],s=e[2],i=t[3]*r+t[7]*n+t[11]*s+t[15];return i=i||1,a[0]=(t[0]*r+t[4]*n+t[8]*s+t[12])/
i,a[1]=(t[1]*r+t[5]*n+t[9]*s+t[13])/i,a[2]=(t[2]*r+t[6]*n+t[10]*s+t[14])/i,a}function ur(a,e,t){var r=e[0],n=e[1],s=e[2];
return a[0]=r*t[0]+n*t[3]+s*t[6],a[1]=r*t[1]+n*t[4]+s*t[7],a[2]=r*t[2]+n*t[5]+s*t[8],a}var Uc=(function(){var a=Va();return function(e,t,r,n,s,i){var o,c;for(t||(t=3),r||(r=0),n?c=Math.min(n*t+r,e.length):c=
e.length,o=r;o<c;o+=t)a[0]=e[o],a[1]=e[o+1],a[2]=e[o+2],s(a,a,i),e[o]=a[0],e[o+1]=a[1],e[o+2]=a[2];return e}})();var W=a=>a,te=()=>[0,0,0],ln=a=>new Array(a).fill(0),R=(a,e)=>an(W(a),W(e)),F=a=>en(W(a)),E=(a,e)=>tn(te(),W(a),W(e)),k=(a,e)=>rn(
te(),W(a),e),I=(a,e)=>on(te(),W(a),W(e)),U=a=>sn(te(),W(a)),P=(a,e,t=1)=>nn(te(),W(a),W(e),t);function nt(a,e,t){let r=Qr(
ln(16),t*Math.PI/180,W(e));return r===null?te():cn(te(),W(a),r)}function O(a,e){let t=Zr(ln(9),a);return ur(te(),W(e),t)}
function Z(a,e){return ur(te(),W(e),a)}function A(a,e,t){return Math.min(Math.max(a,e),t)}var Ba="own cmap";var hn=256;function Ha({scalars:a},e,t,r){let{entries:n,flip:s,maps:i}=a,o=r?r.slice():new Uint8Array(4*n).fill(255),c=o.
length/4-1||1;return o.map((l,h)=>{let[m,u]=[h>>2,h&3],p=Math.round((s?c-m:m)/c*(hn-1));return u===3?l:e[3*(i.indexOf(t)*
hn+p)+u]})}function mn(a,{beyond:e}){let t=a.length/4,r=a instanceof Float32Array;return Float32Array.from({length:a.length+
12},(n,s)=>{let[i,o]=[s>>2,s&3],c=a[4*A(i-1,0,t-1)+o];return o===3?r?i?c:1:0:(i>t?e[i-t]:i?null:e[0])?.[o]??c/255})}function un(a,e,t){let r={...a.scalars};e.scalars===!1&&(r.name=null);let n=r.choices.findIndex(({name:b})=>b===e.scalars);
if(n>=0){let{name:b,label:y,unit:v,steps:x,flat:w}=r.choices[n];Object.assign(r,{name:b,label:y,unit:v,steps:x,flat:w,number:n,
auto:!0})}if(e.cmap&&(r.cmap=e.cmap),Array.isArray(e.clim)&&([r.low,r.high]=e.clim),e.clim!==void 0&&(r.auto=!e.clim),r.
auto&&r.choices[r.number]){let{cmap:b="",least:y,...v}=r.choices[r.number],x=r.log&&y>0,[w,M]=x?[y,v.most]:[v.low,v.high],
S=(w<0&&M>0||r.diverging.includes(b))&&r.diverging.includes(r.cmap),T=Math.max(-w,M);[r.low,r.high]=S?[-T,T]:[w,M]}let{coastlines:s=a.
earth?.coastlines,graticule:i=a.earth?.graticule}=e,o=a.earth&&{...a.earth,coastlines:s,graticule:i},{opacity:c=a.opacity}=e,
l={scalars:r,earth:o,opacity:c},[h,m]=[t.get("maps"),t.get("cmap")?.data],u=m instanceof Float32Array,p=u&&(e.clim!==void 0||
e.scalars!==void 0);if(!h||!(e.cmap||p))return{colours:l,part:null};p&&Object.assign(r,{ticks:[],beyond:[null,null,r.beyond[2]]});
let f=u&&!p,d=e.cmap?Ha(a,h.data,e.cmap,f?m:void 0):Uint8Array.from(m??[]),g=[Ba,e.cmap,f].join();return{colours:l,part:{
name:"cmap",data:d,shape:[d.length/4,4],digest:g}}}var pr=[0,0,1],pn=Math.sin(89*Math.PI/180),za=.2;var pe=a=>Math.tan(a*Math.PI/360),fe=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(e,t,r,n=1,s=0){
this.state=fr(e),this.start=fr(e),this.limits=t,this.flat=r,this.globe=s,this.aspect=n,this.homeHeight=this.height,this.
nearest=this.distance/t.closest}get height(){let{parallel:e,parallel_scale:t,view_angle:r}=this.state;return e?t:this.distance*
pe(r)}get distance(){return F(E(this.state.focal_point,this.state.position))}get zoom(){return this.homeHeight/this.height}get axes(){
let e=U(E(this.state.focal_point,this.state.position)),t=U(I(e,this.state.up));return[t,I(t,e),e]}sight(e){let{parallel:t,
position:r,view_angle:n}=this.state;return t?{eye:null,halfHeight:this.height,pixels:e}:{eye:r,halfHeight:pe(n),pixels:e}}get planes(){
let[e,t,r]=this.axes,{parallel:n,parallel_scale:s,view_angle:i}=this.state,{position:o,focal_point:c}=this.state,l=n?s:pe(
i);return[e,k(e,-1),t,k(t,-1)].map((h,m)=>{let u=m<2?l*this.aspect:l;if(n)return[...h,u-R(h,c)];let p=P(h,r,u);return[...p,
-R(p,o)]})}get eye(){return this.state.parallel?[...k(this.axes[2],-1),0]:[...this.state.position,1]}at(e){let t=this.axes[2];
if(this.state.parallel)return{height:this.height,ray:t};let r=E(e,this.state.position);return{height:R(r,t)*pe(this.state.
view_angle),ray:U(r)}}project(e){let[t,r]=this.axes,{height:n}=this.at(e);if(!(n>0))return null;let{parallel:s,position:i,
focal_point:o}=this.state,c=E(e,s?o:i);return[R(t,c)/n/this.aspect,R(r,c)/n]}pan(e,t){let[r,n]=this.axes,{height:s}=this;
this.shift(P(k(r,e*this.aspect*s),n,t*s))}rotate(e,t){if(this.globe)return this.roam(e,t);let{state:r,limits:n}=this,s=U(
r.up),i=E(r.position,r.focal_point);i=nt(i,s,-n.turn*e*Math.min(this.aspect,n.widest_turn));let o=U(I(s,i));i=nt(i,o,n.turn*
t),r.position=P(r.focal_point,i),r.up=U(I(i,o))}roam(e,t){let{state:r,limits:n,globe:s}=this,i=F(r.position),o=Math.max(
i-s,0)*pe(r.view_angle),c=r.parallel?r.parallel_scale:o,l=Math.min(c/s*180/Math.PI,n.turn),h=Math.hypot(r.position[0],r.
position[1])/i,m=Math.min(l*this.aspect/Math.max(h,za),n.turn);this.turn(pr,-m*e);let[u]=this.axes,p=Math.abs(r.position[2])/
i,f=fr(r);this.turn(u,l*t),Math.abs(r.position[2])/i>Math.max(pn,p)&&(this.state=f);let[,,g]=this.axes,b=P(pr,g,-R(pr,g));
F(b)>1-pn&&(this.state.up=U(b))}turn(e,t){let{state:r}=this;for(let n of["position","focal_point","up"])r[n]=nt(r[n],e,t)}zoomBy(e,t=0,r=0){
if(!Number.isFinite(e)||e<=0)return;this.flat||this.focusAt(t,r);let{farthest_zoom:n,deepest_zoom:s}=this.limits,i=A(e,n/
this.zoom,s/this.zoom),[o,c,l]=this.axes,h=this.height*(1-1/i);this.shift(P(k(o,t*this.aspect*h),c,r*h)),this.state.parallel?
this.state.parallel_scale/=i:this.approach(this.height/i,l)}ray(e,t){let[r,n,s]=this.axes,{height:i,state:o}=this,c=P(P(
o.focal_point,r,e*this.aspect*i),n,t*i);return o.parallel?[P(c,s,-this.distance),s]:[P(o.position,[0,0,0]),U(E(c,o.position))]}approach(e,t){
let r=Math.max(e/pe(this.limits.view_angle),this.nearest);this.state.position=P(this.state.focal_point,t,-r),this.state.
view_angle=Math.atan(e/r)*360/Math.PI}focusAt(e,t){let r=this.pick?.(e,t);if(!r)return;let n=this.axes[2],s=R(E(r,this.state.
position),n);s>0&&(this.state.focal_point=P(this.state.position,n,s))}shift(e){this.state.focal_point=P(this.state.focal_point,
e),this.state.position=P(this.state.position,e)}};function fr(a){let{position:e,focal_point:t,up:r}=a;return{...a,position:[
...e],focal_point:[...t],up:[...r]}}function z(a,e,t){let{state:r,aspect:n}=e,{center:s,extent:i,frame:o}=a,[c,l,h]=e.axes.map(S=>O(o,S)),m=S=>E(O(o,E(S,s)),
t),u=m(r.focal_point),p=k(t,-1),f=Math.max(.51*i,a.reach??0),d=new Array(16).fill(0),g=r.parallel?r.parallel_scale:pe(r.
view_angle);if([c.map(S=>S/g/n),l.map(S=>S/g)].forEach((S,T)=>{for(let L=0;L<3;L+=1)d[4*L+T]=S[L];d[12+T]=-R(S,u)}),r.parallel){
for(let S=0;S<3;S+=1)d[4*S+2]=h[S]/f;return d[14]=-R(h,p)/f,d[15]=1,d}let y=m(r.position),v=R(E(p,y),h),x=Math.max(v+f,.001*
f),w=Math.max(v-f,.001*x),M=(x+w)/(x-w),_=-2*x*w/(x-w);for(let S=0;S<3;S+=1)d[4*S+2]=h[S]*M,d[4*S+3]=h[S];return d[15]=-R(
h,y),d[14]=d[15]*M+_,d}function fn({center:a,frame:e},t,r,n,s){let[i,o]=t.axes,{height:c,state:l,aspect:h}=t,[m,u]=[k(i,
2*c*h/n),k(o,2*c/s)],p=P(P(E(l.focal_point,a),m,-n/2),u,-s/2);return{u_rayCorner:E(O(e,p),r),u_rayX:O(e,m),u_rayY:O(e,u)}}var ae=8,gn=9,Ga=.2,Wa=1.4,dn=55,$a=125,ja=.5,Ya=4,bn=4e-5,yn=2e-6;function vn(a,e,t,r,n){let s=Math.max(n-e,Math.min(e/
2,n),2)/a;if(t*(r+ae)<=s)return{scale:1,samples:r};let i=Math.min(gn,r),o=Math.sqrt(s/(i+ae)/t);return o<1?{scale:Math.max(
o,Ga),samples:i}:{scale:1,samples:A(Math.floor(s/t-ae),i,r)}}function xn(a,e,t,r,n){if(!n)return dn;let s=Math.min(gn,r),
i=e+a*t*ja**2*(s+ae);return A(i,dn,$a)}function wn(a,e,t,r){return Math.max(Math.floor(a/(e*t*(r+ae))),Ya)}function Mn(a){
return(2*a+ae)/(a+ae)}function En(a,e,t,r,n){let s=Math.max(e,.05)/(t*(r+ae)*n);return a+(s-a)*(s>a?.7:.3)}function Sn(a,e,t){
let[r,n,s]=[a.grain,a.spacing,a.samples].map(Number),i=Math.max(r*t,Math.min(r,1)),c=s*n*r*t/(e*i);return{u_grain:i,u_spacing:A(
c,.1,Math.max(Wa,n))}}var Xa=`#version 300 es
precision highp float;
precision highp int;
`,qa=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexScalar","flowtexCorners","flowtexRadius"],de=["u_sli\
ces","u_slicesNext","u_image","u_stepImage","u_cmap","u_shares","u_along","u_nodes","u_corners","u_open","u_places","u_d\
epths","u_colours","u_strides"],Se=class{graphics;entries=new Map;parallel=null;constructor(e){this.graphics=e}findFeatures(){
this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){this.entries.clear()}dispose(){for(let e of this.
entries.values()){for(let t of e.shaders)this.graphics.free("Shader",t);this.graphics.free("Program",e.program)}this.clear()}get(e,t,...r){
let n=[e,t,...r].join("\0"),s=this.entries.get(n);return s||this.entries.set(n,s=this.build(e,t,r)),!s.ready&&!s.error&&
this.finish(s),s}build(e,t,r){let{graphics:n}=this,s=n.context,i=n.counted(s.createProgram()),o=[s.VERTEX_SHADER,s.FRAGMENT_SHADER],
c=Xa+r.map(m=>`#define ${m}
`).join(""),l=[e,t].map((m,u)=>{let p=n.counted(s.createShader(o[u]));return s.shaderSource(p,m.startsWith("#version")?m:
c+m),s.compileShader(p),s.attachShader(i,p),p});return qa.forEach((m,u)=>s.bindAttribLocation(i,u,m)),s.linkProgram(i),{
program:i,shaders:l,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:bn}}}finish(e){let t=this.graphics.context,{program:r}=e,
n=this.parallel?.COMPLETION_STATUS_KHR;if(n&&!t.getProgramParameter(r,n))return;if(!t.getProgramParameter(r,t.LINK_STATUS)){
if(t.isContextLost())return;let o=[...e.shaders.map(c=>t.getShaderInfoLog(c)),t.getProgramInfoLog(r)].filter(Boolean).join(
`
`);e.error=o||"the driver gave no reason";return}for(let i of e.shaders)this.graphics.free("Shader",i);e.shaders=[];let s=t.
getProgramParameter(r,t.ACTIVE_UNIFORMS);for(let i=0;i<s;i+=1){let o=t.getActiveUniform(r,i),c=o&&t.getUniformLocation(r,
o.name);!o||!c||e.uniforms.set(o.name.replace(/\[0\]$/,""),{location:c,type:o.type})}t.useProgram(r),de.forEach((i,o)=>{
let c=e.uniforms.get(i);c&&c.type!==t.FLOAT_VEC2&&t.uniform1i(c.location,o)}),e.ready=!0}use(e,t){let r=this.graphics.context;
r.useProgram(e.program);for(let[n,s]of Object.entries(t)){let i=e.uniforms.get(n);if(!i)continue;let{location:o,type:c}=i,
l=typeof s=="object"?s:[Number(s)];c===r.FLOAT?r.uniform1fv(o,l):c===r.FLOAT_VEC2?r.uniform2fv(o,l):c===r.FLOAT_VEC3?r.uniform3fv(
o,l):c===r.FLOAT_VEC4?r.uniform4fv(o,l):c===r.FLOAT_MAT4?r.uniformMatrix4fv(o,!1,l):r.uniform1i(o,l[0])}}};var Ka=4,Ja=45,Za=[4,68],Qa=Symbol.for("flowtex.gl/3");function An(a){return["EXT_color_buffer_float","EXT_color_buffer_\
half_float"].some(e=>a.getExtension(e)!==null)}var dr=class{canvas=document.createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16;let e=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"hi\
gh-performance"});this.gl=e&&An(e)?e:null,this.programs=new Se(this),this.gl&&this.programs.findFeatures(),this.canvas.addEventListener(
"webglcontextlost",t=>{t.preventDefault(),this.isLost=!0,this.objects=0,this.programs.clear(),this.common.clear(),this.tracings.
clear(),this.picker=this.smooth=null;for(let r of this.users)r.lost()}),this.canvas.addEventListener("webglcontextrestor\
ed",()=>{this.isLost=!1,this.gl&&An(this.gl)&&this.programs.findFeatures();for(let t of this.users)t.change()})}get context(){
if(!this.gl)throw new Error("WebGL2 is not available");return this.gl}leave(e){if(this.users.delete(e),this.waiting.delete(
e),!this.users.size){cancelAnimationFrame(this.scheduled),this.scheduled=0,this.programs.dispose();for(let t of[this.picker,
this.smooth])t&&this.freeTarget(t);this.picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(e){this.
waiting.add(e),this.scheduled||=requestAnimationFrame(t=>this.run(t))}run(e){this.scheduled=0;let t=performance.now()+Ja;
for(let r of[...this.waiting])if(this.waiting.delete(r),r.frame(e,t),performance.now()>t)break;this.waiting.size&&(this.
scheduled||=requestAnimationFrame(r=>this.run(r)))}counted(e){if(e===null)throw new Error("the graphics card has no memo\
ry left, or the context is lost");return this.objects+=1,e}free(e,t){if(t===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${e}`](t)}hold(e){if(!e.digest)return e;let t=this.stock.get(e.digest)??{part:e,users:0};return this.stock.
set(e.digest,{...t,users:t.users+1}),t.part}release(e){let t=e&&this.stock.get(e.digest);!e||!t||(t.users-=1,t.users||this.
stock.delete(e.digest))}target(e,t,r,n){let s=this.context,i=this.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,
i);let c=[[e,s.COLOR_ATTACHMENT0],[s.DEPTH_COMPONENT24,s.DEPTH_ATTACHMENT]].map(([l,h])=>{let m=this.counted(s.createRenderbuffer());
return s.bindRenderbuffer(s.RENDERBUFFER,m),s.renderbufferStorageMultisample(s.RENDERBUFFER,n,l,t,r),s.framebufferRenderbuffer(
s.FRAMEBUFFER,h,s.RENDERBUFFER,m),m});return{frame:i,buffers:c}}freeTarget(e){this.free("Framebuffer",e.frame);for(let t of e.
buffers)this.free("Renderbuffer",t)}bindSmooth(e,t){let r=this.context,n=this.smooth;if(!n||n.width<e||n.height<t){let[s,
i]=[Math.max(e,n?.width??0),Math.max(t,n?.height??0)];n&&this.freeTarget(n);let o=this.target(r.RGBA8,s,i,Ka);this.smooth=
{...o,width:s,height:i}}r.bindFramebuffer(r.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(e,t){let r=this.context;r.bindFramebuffer(
r.READ_FRAMEBUFFER,this.smooth?.frame??null),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,null),r.disable(r.SCISSOR_TEST),r.blitFramebuffer(
0,0,e,t,0,0,e,t,r.COLOR_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,null)}numbers(e,t=1,r=1){let n=this.context;
this.picker??=this.target(n.RGBA32UI,...Za,0),n.bindFramebuffer(n.FRAMEBUFFER,this.picker.frame),n.viewport(0,0,t,r),n.disable(
n.SCISSOR_TEST),n.enable(n.DEPTH_TEST),n.clearBufferuiv(n.COLOR,0,[0,0,0,0]),n.clear(n.DEPTH_BUFFER_BIT),e();let s=new Uint32Array(
4*t*r);return n.readPixels(0,0,t,r,n.RGBA_INTEGER,n.UNSIGNED_INT,s),n.bindFramebuffer(n.FRAMEBUFFER,null),s}};function Tn(){
let a=globalThis;return a[Qa]??=new dr}var st=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(e,t,r){let[n,s]=t;this.poles=e,this.nodes=t,this.rays=
r,this.isAlongJ=e[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[n,s-1]:[s,n-1];let i=e.reduce((o,c)=>o+this.depth(
c)+1,0);this.size={width:s+(this.isAlongJ?0:i),height:n+(this.isAlongJ?i:0)}}laidOut(e){if(!this.poles.length)return e;let[
t,r]=this.nodes,{width:n,height:s}=this.size,i=new Float32Array(4*n*s);for(let o=0;o<t;o+=1)i.set(e.subarray(4*r*o,4*r*(o+
1)),4*n*o);return this.poles.forEach((o,c)=>this.fill(i,o,c)),i}fastest(e){let t=0;for(let r=0;r<(this.isAlongJ?this.size.
height:this.size.width);r+=1){let n=s=>(r-s.line)*s.inward<s.near;if(!(r<this.lines&&this.poles.some(n)))for(let s=0;s<=
this.cells;s+=1){let i=this.at(r,s);t=Math.max(t,Math.abs(e[i]),Math.abs(e[i+1]))}}return t}at(e,t){return 4*(this.isAlongJ?
e*this.size.width+t:t*this.size.width+e)}depth({near:e}){return Math.min(e+3,this.lines-1)}shift(e){let t=this.poles.slice(
0,e).reduce((s,i)=>s+this.depth(i)+1,0),{inward:r,line:n}=this.poles[e];return this.lines+t-(r>0?n:n-this.depth(this.poles[e]))}ray(e,t){
let r=2*(e*(this.cells+1)+t);return[this.rays[r],this.rays[r+1]]}fill(e,t,r){let{cells:n}=this,{line:s,inward:i,component:o}=t,
[c,l]=[this.shift(r),this.still(e,t,r)];for(let h=0;h<=this.depth(t);h+=1)for(let m=0;m<=n;m+=1){let u=this.at(s+i*h,m),
p=this.at(s+i*h+c,m),[f,d]=[e[u+1-o],e[u+o]],[g,b,y]=[m,(m+1)%n,(m+n-1)%n].map(v=>this.ray(r,v));for(let v of[0,1]){let x=(b[v]-
y[v])/2;e[p+v]=h?i*d*g[v]+f*h*x:l[v]}e.copyWithin(p+2,u+2,u+4)}}still(e,{line:t,inward:r,component:n},s){let[i,o,c,l,h]=[
0,0,0,0,0];for(let u=0;u<this.cells;u+=1){let[p,f]=this.ray(s,u),d=p*p+f*f,g=e[this.at(t,u)+n]*r;[l,h]=[l+g*p,h+g*f],[i,
o,c]=[i+p*p/d,o+p*f/d,c+f*f/d]}let m=i*c-o*o;return[(c*l-o*h)/m,(i*h-o*l)/m]}get raysSize(){return[this.cells+1,Math.max(
this.poles.length,1)]}get angles(){let{cells:e}=this,[t,r]=this.raysSize,n=new Float32Array(4*t*r);return this.poles.forEach(
(s,i)=>{let o=[];for(let c=0;c<=e;c+=1){let[l,h]=this.ray(i,c),m=Math.atan2(h,l);for(;m<o[c-1];)m+=2*Math.PI;o.push(m)}o.
forEach((c,l)=>{let h=o[0]+2*Math.PI*l/e+1e-6,m=o.findLastIndex(u=>u<=h);n.set([c,Math.hypot(...this.ray(i,l)),m],4*(i*t+
l))})}),n}get uniforms(){let e=this.poles.flatMap(({line:r,inward:n,near:s},i)=>[r,n,s,this.shift(i)]),t=this.poles.flatMap(
({plane:r})=>r);for(;e.length<8;)e.push(0);for(;t.length<12;)t.push(0);return{u_poles:e,u_planes:t,u_polar:Number(this.isAlongJ)}}};var _n=32767,[ei,ti,ri,ni]=[0,1,2,3],si=2,ai=8,ii=4,oi=4,ci=64,li=64,hi=2e4,mi=1e30,Pn=1e-5;function Rn(a,e,t){let[r,n]=t,
s=a.shape[1],[i,o]=e.drawn,c=new Float64Array(r*n*3);for(let l=0,h=0;l<r;l+=1){let m=3*((l+i+1)*s+o+1);for(let u=0;u<3*n;u+=
1)c[h++]=a.data[m+u]+e.middle[u%3]}return{data:c,shape:[r,n,3]}}function Ln(a,e,t){let[r,n]=t,s=3*a.shape[1],[i,o]=e.drawn,
c=new Int16Array(r*n*3);for(let l=0,h=0;l<r;l+=1)for(let m=0;m<n;m+=1,h+=3){let u=s*(l+i+1)+3*(m+o+1),p=g=>[0,1,2].map(b=>a.
data[u+g+b]-a.data[u-g+b]),f=I(p(3),p(s)),d=F(f)||1;for(let g=0;g<3;g+=1)c[h+g]=Math.round(f[g]/d*_n)}for(let{component:l,
line:h,inward:m}of e.poles??[]){let[u,p]=l?[h-i,n]:[h-o,r];if(u<0||u>=(l?r:n))continue;let f=(y,v)=>3*(l?y*n+v:v*n+y),d=[
0,0,0];for(let y=0;y<p;y+=1)for(let v=0;v<3;v+=1)d[v]+=c[f(u+m,y)+v];let g=F(d)||1,b=d.map(y=>Math.round(y/g*_n));for(let y=0;y<
p;y+=1)c.set(b,f(u,y))}return{data:c,shape:[r,n,3]}}function ie({slices:a},e){let{trace:t,times:r,lags:n}=a;if(!t?.pathlines||
!t.timed)return[e];let s=n[n.length-1]*t.timed.unit,i=r.map(c=>Math.abs(c-r[e])<s),o=c=>i[c]||i[c-1]||i[c+1];return[...r.
keys()].filter(o)}function ui({slices:a},e,t,r,n){let{trace:s,times:i}=a;if(!s?.pathlines||!s.timed)return[{from:r,to:n,
steps:[e,e],between:[0,1]}];let o=[],{unit:c}=s.timed,l=h=>t*(i[h]-i[e])/c;for(let h=e;r<n;h+=t){let m=!(h+t in i),u=m?n:
l(h+t);if(u<=r+Pn*n)continue;let p=m?[0,1]:[l(h),u],f=u>=n-Pn*n;o.push({from:r,to:f?n:u,steps:[h,m?h:h+t],between:p}),r=
f?n:u}return o}function at({programs:a},e,t){let{fullVertex:r,trace:n="",layers:s=""}=e.shaders,i=(c,...l)=>{let h=l.filter(
u=>typeof u=="string"),m=a.get(r,c,...h);if(m.error)throw new Error(`the tracer cannot be built: ${m.error}`);return m},
o=t.poles!==void 0&&"FLOWTEX_POLES";return{follow:i(n,o,t.pathlines&&"FLOWTEX_PATHLINES"),compose:t.pathlines?null:i(n,o,
"FLOWTEX_COMPOSED"),slopes:i(s,"FLOWTEX_SLOPES"),tangents:i(s,o)}}var it=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(e,t,r,n,s){
this.graphics=e,this.header=t,this.trace=r,this.find=n,this.poles=new st(r.poles??[],r.nodes,n("rays")?.data??[]),this.passes=
this.slices(s)}advance(e){if(!Object.values(at(this.graphics,this.header,this.trace)).every(r=>r?.ready??!0))return null;
let t=this.graphics.context;try{do{let{done:r,value:n}=this.passes.next();if(t.isContextLost())return null;if(r)return this.
result=null,n}while(performance.now()<e);return null}finally{this.unbind()}}dispose(){for(let e of this.textures)this.graphics.
free("Texture",e);for(let e of this.frames)this.graphics.free("Framebuffer",e);this.result&&!this.graphics.context.isContextLost()&&
this.graphics.context.deleteTexture(this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(e){let t=this.
find(e);if(!t)throw new Error(`the part "${e}" of the scene is missing`);return t.data}numbers(e){let t=this.data(e);return t instanceof
Float32Array?t:new Float32Array(t).map(r=>Le[r])}texture(e,t,r,n){let s=this.graphics.context,i=this.graphics.counted(s.
createTexture());return this.textures.add(i),s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D,i),s.texStorage2D(s.
TEXTURE_2D,1,r,e,t),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),n&&s.texSubImage2D(s.TEXTURE_2D,0,0,0,e,t,s.RGBA,s.FLOAT,n),i}frame(){let e=this.graphics.context,t=this.graphics.
counted(e.createFramebuffer());return this.frames.push(t),e.bindFramebuffer(e.FRAMEBUFFER,t),t}target(e,t){let r=this.graphics.
context,n=this.texture(e,t,r.RGBA32UI,null),s=this.frame();return r.framebufferTexture2D(r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,
r.TEXTURE_2D,n,0),[n,s]}unbind(){let e=this.graphics.context;for(let t=0;t<ai;t+=1)e.activeTexture(e.TEXTURE0+t),e.bindTexture(
e.TEXTURE_2D,null),e.bindTexture(e.TEXTURE_2D_ARRAY,null);e.bindFramebuffer(e.FRAMEBUFFER,null)}flow(e){let{trace:t}=this,
r=this.numbers(`flow/${e}`),n=this.data("unit"),s=r.length/n.length,i=new Float32Array(4*n.length);for(let c=0,l=0;c<n.length;c+=
1,l+=s){let h=r[l+2],m=Le[n[c]]*t.unit;i[4*c]=r[l]*h/m,i[4*c+1]=r[l+1]*h/m,i[4*c+2]=h,i[4*c+3]=t.timed?t.timed.unit:m}let o=this.
poles.laidOut(i);return t.timed&&(this.fastest=Math.max(this.fastest,this.poles.fastest(o)*t.timed.speed*t.timed.unit)),
o}wholeSpeed(e){let t=this.numbers(`flow/${e}`),r=this.data("unit").length,n=t.length/r,s=Number(this.trace.uncertain??!1),
i=new Float32Array(4*r);for(let o=0;o<r;o+=1)i[4*o]=t[(o+1)*n-1-s],i[4*o+1]=s*t[(o+1)*n-1];return i}cells(){let[e,t]=this.
trace.nodes,[r,n]=["open","nearest"].map(i=>this.find(i)?.data),s=new Float32Array(4*e*t);for(let i=0;i<e*t;i+=1){s[4*i]=
r?r[i]:1;for(let o of[0,1])s[4*i+1+o]=n?n[2*i+o]:0}return s}padded(){let e=this.data("padded"),t=new Float32Array(e.length/
3*4);for(let r=0;r<e.length/3;r+=1)for(let n=0;n<3;n+=1)t[4*r+n]=e[3*r+n];return t}flowTexture(e){let{width:t,height:r}=this.
poles.size,n=this.graphics.context,i=this.flows.get(e)??this.texture(t,r,n.RGBA32F,this.flow(e));this.flows.delete(e),this.
flows.set(e,i);for(let[o,c]of this.flows){if(this.flows.size<=oi)break;this.flows.delete(o),this.textures.delete(c),this.
graphics.free("Texture",c)}return i}partsOf({from:e,to:t}){let r=A(Math.ceil((t-e)*this.fastest/ci),1,li),n=s=>s===r?t:e+
(t-e)*s/r;return Array.from({length:r},(s,i)=>[n(i),n(i+1)])}*slices(e){let{graphics:t,trace:r,header:n}=this,s=t.context,
{geometry:i,slices:o}=n,[c,l]=r.nodes,[h,m]=[i.rows.size,i.columns.size],u={width:m,height:h,layers:o.count,channels:4,levels:i.
levels},p=s.createTexture();this.result=p,s.activeTexture(s.TEXTURE0),et(s,p,u);let{poles:f}=this,d=this.texture(f.size.
width,f.size.height,s.RGBA32F,this.flow(e)),g=this.texture(...f.raysSize,s.RGBA32F,f.angles),b=[this.texture(l,c,s.RGBA32F,
this.cells()),this.texture(l+2,c+2,s.RGBA32F,this.padded()),this.texture(l,c,s.RGBA32F,this.wholeSpeed(e))],y=[0,1,2,3,4].
map(()=>this.target(l,c)),{lags:v,sides:x,count:w}=o,M={u_flow:0,u_cells:1,u_padded:2,u_speed:3,u_before:4,u_last:5,u_earlier:5,
u_flowNext:6,u_rays:7,...f.uniforms,u_longest:r.longest??mi,u_nodes:[l,c],u_closed:[Number(r.closed[1]),Number(r.closed[0])],
u_first:[r.first[1],r.first[0]],u_texels:[m,h],u_offsetJ:r.offset.slice(0,3),u_offsetI:r.offset.slice(3,6),u_timed:r.timed?.
speed??0,u_rest:r.rest,u_pace:r.pace,u_unit:o.unit,u_cell:o.cell/o.unit,u_planar:Number(i.planar),u_mostReach:2*v[v.length-
1]},_=([C,J],we,he,Re)=>{s.viewport(0,0,C,J);for(let Y of[s.SCISSOR_TEST,s.DEPTH_TEST,s.BLEND,s.CULL_FACE])s.disable(Y);
we.forEach((Y,ee)=>{s.activeTexture(s.TEXTURE0+ee),s.bindTexture(s.TEXTURE_2D,Y)}),s.bindVertexArray(null),t.programs.use(
he,{...M,...Re}),s.drawArrays(s.TRIANGLES,0,3)},S=this.frame(),T=(C,J,we,he)=>{s.bindFramebuffer(s.FRAMEBUFFER,S),s.framebufferTextureLayer(
s.FRAMEBUFFER,s.COLOR_ATTACHMENT0,p,0,C),_([m,h],[d,...b,...we],J,he)},{follow:L,compose:N,slopes:H,tangents:K}=at(t,n,r);
T(0,K,[],{u_inCells:0}),w>1+x*v.length&&T(w-1,K,[],{u_inCells:1});let se=0;for(let C=0;C<x;C+=1){let J=C?1:-1,we=1+C*v.length,
[he,Re,Y]=[y[0],y[0],y[0]];for(let[ee,Ze]of v.entries()){let[Ur,Vr]=[v[ee-1]??0,v[ee-2]??0],Dr=Ze>ii&&Vr>0?N:null,Qe=Y;for(let ir of ui(
n,e,J,Ur,Ze)){let[Pa,Ra]=ir.steps.map(or=>this.flowTexture(or)),La=Dr?[[Ur,Ze]]:this.partsOf(ir);for(let[or,ka]of La){let Br=y.
find(Oa=>![he,Re,Y,Qe].includes(Oa))??y[0];s.bindFramebuffer(s.FRAMEBUFFER,Br[1]),_([l,c],[Pa,...b,Qe[0],Re[0],Ra,g],Dr??
L,{u_lagEarlier:Vr,u_from:or,u_to:ka,u_side:J,u_between:ir.between}),Qe=Br,!((se+=c*l)<hi)&&(s.readPixels(0,0,1,1,s.RGBA_INTEGER,
s.UNSIGNED_INT,new Uint32Array(4)),se=0,yield)}}[Re,Y]=[Y,Qe],ee||(he=Y);let Ta=r.uncertain&&ee===si,_a=ee===1&&!C?ti:Ta?
ni:ei;ee&&T(we+ee,H,[Y[0],Y[0]],{u_fourth:_a,u_lag:J*Ze})}T(we,H,[he[0],Y[0]],{u_fourth:ri,u_lag:J*v[0]})}return s.activeTexture(
s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,p),u.levels&&s.generateMipmap(s.TEXTURE_2D_ARRAY),p}};var pi={slices:[12,4],flow:[100,24]},fi=24,ot=class{all=new Map;graphics;constructor(e){this.graphics=e}set(e){let{name:t,
digest:r}=e;if(r&&this.all.get(t)?.digest===r)return!1;let n=this.graphics.hold(e);return this.remove(t),this.all.set(t,
n),!0}remove(e){this.graphics.release(this.all.get(e)),this.all.delete(e)}clear(e=()=>!0){for(let t of[...this.all.keys()])
e(t)&&this.remove(t)}trim(e,t,r){let{hasSteps:n=!1,hasMarks:s=!1,memory:i=0}=t??{};if(!e||!n)return;for(let h of s?Object.
keys(Me):[]){let m=[...this.all.keys()].filter(u=>u.startsWith(`${h}/`));for(let u of m.slice(0,-fi))r.includes(X(u))||this.
remove(u)}let o=e.slices.trace?"flow":"slices",c=h=>[...this.all.keys()].filter(m=>m.startsWith(h)),l=r.flatMap(h=>ie(e,
h));for(let h of c(`${o}/`).slice(0,-pi[o][+(i>0)])){let m=X(h);if(l.includes(m))continue;for(let p of[o,"extra"])this.remove(
`${p}/${m}`);let u=i?c("scalars/"):[];for(let p of u)Ee(p,m,e)&&this.remove(p)}}};var ct=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(e,t,r,n={}){(e===document||e===window)&&(this.globalListeners+=1);let{signal:s}=this.controller;
e.addEventListener(t,r,{...n,signal:s})}later(e,t){let r=setTimeout(()=>{this.timers.delete(r),e()},t);return this.timers.
add(r),r}cancel(e){e!==null&&(clearTimeout(e),this.timers.delete(e))}observe(e,t){e.observe(t),this.observers.add(e)}watch(e,t,r){
e.observe(t,r),this.observers.add(e)}stats(){let{globalListeners:e,observers:t,timers:r}=this;return{listeners:e,observers:t.
size,timers:r.size}}end(){this.controller.abort(),this.globalListeners=0;for(let e of this.observers)e.disconnect();this.
observers.clear();for(let e of this.timers)clearTimeout(e);this.timers.clear()}};function kn(a,e,t){let{geometry:r,slices:n,constants:s}=a,i=e,o=me(a),c=2**(Math.floor(Math.log2(r.extent))-s.noiseDoublings),
l=t.eye[3],h=O(r.frame,E(t.eye,k(r.center,l))),m=On(a,e),u=m?"ramp":i.kernel,p=o&&u==="ramp"?"hann":u;return{u_eye:[...E(
h,k(t.anchor,l)),l],u_between:t.between,u_slicesSize:[r.columns.size,r.rows.size],u_deepest:r.levels,u_lags:n.lags,u_lagCount:n.
lags.length,u_sides:i.two_sided||o||m?n.sides:1,u_unit:n.unit,u_rateLayer:n.count-1,u_cell:n.cell,u_samples:lt(a,e,t.still)?
2*i.samples-1:i.samples,u_spacing:i.spacing,u_grain:i.grain*t.density,u_kernel:s.kernels.indexOf(p),u_lod:i.lod,u_contrast:i.
contrast,u_strength:i.strength,u_fade:o?0:i.fade,u_seed:i.seed,u_showLevel:i.show_level,u_fixed:i.fixed_grain,...di(a,i,
t),...gi(a,t,c),u_noiseFinest:c,u_texel:r.extent/i.resolution,u_apart:gr(a,e)*t.density,u_bySpeed:e.arrow_length==="spee\
d",u_arrowSides:n.sides,u_pieces:s.arrows.pieces,...a.image?bi(a.image,i.tiles,t.density):{}}}function lt(a,e,t=!1){let r=e.
motion!=="off"&&!me(a);return!a.image&&(r||a.slices.steps>1&&!t)}function On(a,e){return!a.image&&e.texture==="streaklet\
s"}function ke(a,e){return Number(e.arrows)>0&&!me(a)&&!a.image}function gr({constants:a},{arrows:e}){return a.arrows.least*
Math.max(Number(e),a.arrows.mostDense)}function ht(a,e,t){let{geometry:r,slices:n,constants:s}=a,i=e,o=Math.hypot(...E(t.
eye,r.center))-.5*r.extent,c=t.eye[3]?Math.max(o,0)/Math.hypot(...E(t.eye,t.focus)):1,l=i.lod?t.pixel*c*i.grain*t.density:
r.extent/i.resolution;return Math.floor(i.samples/2)*i.spacing*l<s.farCells*n.critical}function Fn(a,e,t,r){let n={FLOWTEX_CELLS:t,
FLOWTEX_MOVING:lt(a,e,r),FLOWTEX_SPARSE:On(a,e)};return Object.entries(n).flatMap(([s,i])=>i?[s]:[])}function di(a,e,t){
let{geometry:r,constants:n}=a,{times:s,pace:i}=a.slices,o=s.length>1,c=!o&&e.speed_in==="pixels",l=s[s.length-1]-s[0],h=l*
i/r.extent,m=o?l/(Math.round(h)||h):e.period,u=(o?t.time-s[0]:t.clock)/m%n.mostTurns,p=m*(o?i:e.speed),f=u%n.clockStep;return{
u_clock:[u-f,f],u_travel:p*(c?t.density:1),u_travelInPixels:c,u_travelBySpeed:o||e.motion==="speed",u_wave:n.wavePixels*
t.density}}function gi(a,e,t){let{noiseDoublings:r,clearDoublings:n}=a.constants,{frame:s,center:i}=a.geometry,o=O(s,E(e.
focus,i)),c=2**(r-n)-1,l=2**n,h=o.map(p=>A(Math.round(p/t/l),-c,c)*l),m=h.map(p=>p/Math.SQRT2),u=m.map(p=>Math.floor(p/l)*
l);return{u_noiseOrigin:h.map((p,f)=>p*t-e.anchor[f]),u_noiseOriginEven:h,u_noiseOriginOdd:u,u_noiseRestOdd:m.map((p,f)=>p-
u[f])}}function bi({size:a,stepSize:e,repeat:t},r,n){return{u_stepSize:e.map(s=>s*n),u_imageSize:a.map(s=>s*n*r),u_imageRound:[
Number(t[1]),Number(t[0])],u_tiles:r}}function br(a,e){if(a.length<2)return[0,0,0];let t=0;for(;t<a.length-2&&a[t+1]<=e;)
t+=1;let r=(e-a[t])/(a[t+1]-a[t]);return[t,t+1,A(r,0,1)]}var yi=.5,vi=6,xi=60,wi=.5,mt=class{time=0;clock=0;playing=!1;pace=1;times=[0];lastFrame=0;hasHeader=!1;setHeader(e){let{
times:t}=e.slices;(!(t.length===this.times.length&&t.every((n,s)=>n===this.times[s]))||!this.hasHeader)&&(this.time=e.time,
this.clock=e.clock),this.hasHeader=!0,this.times=t}get varies(){return this.times.length>1}get span(){return[this.times[0],
this.times[this.times.length-1]]}get moment(){return br(this.times,this.time)}timeOf([e,t,r]){return this.times[e]+r*(this.
times[t]-this.times[e])}seek(e){this.time=A(e,...this.span)}stepFrom(e){let{times:t,time:r}=this,n=t.findIndex(o=>e>0?o>
r:o>=r),s=t.length,i=n<0?s:n;return t[(e>0?i:i-1+s)%s]}start(){this.playing=!0,this.lastFrame=0}range(e){if(this.varies)
return{first:this.span[0],last:this.span[1],now:this.time};let t=Number(e.period);return{first:0,last:t,now:this.clock%t}}advance(e,t){
let r=this.lastFrame?Math.min((e-this.lastFrame)/1e3,wi)*this.pace:0;if(this.lastFrame=e,!this.varies)return this.clock+=
r,!0;let[n,s]=this.span,i=A(yi*(this.times.length-1),vi,xi),o=this.time+r*(s-n)/i,[c,l]=br(this.times,Math.min(o,s));return t(
[c,l])?(this.time=o>s?n:o,!0):!1}};var Nn=()=>null,ut=class{};var V="",In=5,G=a=>a.join("/"),oe=a=>a.split("/").map(Number);function Cn(a,e){let[t,r,n]=["samples","spacing","grain"].
map(i=>Number(e[i])),s=.5*t*r*n;return a.cellPixels*Math.max(1,2*s/(a.cellPixels*a.pathCells))}var pt=class{header;place;constructor(e,t){
this.header=e;let r=0,n=e.blocks.map(([s,i])=>(r+=s*i)-s*i);this.place=typeof t=="function"?t:(s,i,o)=>{let c=In*(n[s]+i*
e.blocks[s][1]+o);return t.subarray(c,c+In)}}blocksOf(e,[t,r,n]){let[s,i]=this.header.blocks[t];if(e===V)return[0,0,s,i];
let{tileBlocks:o}=this.header,c=[Math.min(o*(r+1),s),Math.min(o*(n+1),i)];return[o*r,o*n,...c]}children(e,[t,r,n]){let{blocks:s,
tileBlocks:i}=this.header,o=s[t-1].map(m=>Math.ceil(m/i)),[c,l]=e===V?[[0,0],o]:[[2*r,2*n],[r,n].map((m,u)=>Math.min(2*m+
2,o[u]))],h=[];for(let m=c[0];m<l[0];m+=1)for(let u=c[1];u<l[1];u+=1)h.push([t-1,m,u]);return h}finerPart([,e,t],r){let{
tileBlocks:n}=this.header,s=n/2,[,i,o]=r===V?[0,0,0]:oe(r);return[s*e-n*i,s*t-n*o,s]}choose(e){let t=new Map,{depth:r,finest:n}=this.
header,s=[V];for(let i of s){let o=i===V?[r,0,0]:oe(i),c={key:o,needed:!1,pixels:0,finer:[]},[l,h,m,u]=this.blocksOf(i,o),
p=this.header.blocks[o[0]][1],f=new Set;for(let d=l;d<m;d+=1)for(let g=h;g<u;g+=1){let b=this.place(o[0],d,g);if(!yr(e,b)||
e.shownOn?.sees(b)===!1)continue;let y=vr(e,b)*(e.shownOn?.scale(b)??1);o[0]>n&&y>e.cellPixels?f.add(d*p+g):c.needed=!0,
f.has(d*p+g)||(c.pixels=Math.max(c.pixels,y))}f.size&&(c.finer=this.children(i,o).filter(d=>{let[g,b,y]=this.finerPart(d,
V);return[...f].some(v=>{let[x,w]=[Math.floor(v/p)-g,v%p-b];return x>=0&&x<y&&w>=0&&w<y})}).map(G)),t.set(i,c),s.push(...c.
finer)}return t}};function yr({planes:a},[e,t,r,n]){return a.every(s=>R(s,[e,t,r])+s[3]>=-n*F(s.slice(0,3)))}function vr({
eye:a,halfHeight:e,pixels:t},[r,n,s,i,o]){let c=a?Math.max(F(E([r,n,s],a))-i,o):1;return o*.5*t/(e*c)}function Un(a){return[
...a].filter(([t,{needed:r}])=>t!==V&&r).sort(([,t],[,r])=>r.pixels-t.pixels).map(([t])=>t)}function xr(a,e){let t=new Map,
r=s=>{t.delete(s),a.get(s)?.finer.forEach(r)},n=s=>{let{needed:i=!1,finer:o=[]}=a.get(s)??{},c=o.filter(n);return s!==V&&
!i&&c.length===o.length?!0:s!==V&&!e(s)?(c.forEach(r),!1):(t.set(s,c),!0)};return n(V),t}function ft(a,e,t){let r=s=>Math.
min(s*2**e,t-1),n=Math.floor(a);return r(n)+(a-n)*(r(n+1)-r(n))}function Vn(a,e,t){let r=2**e,n=Math.max(Math.min(Math.floor(
a/r),Math.ceil((t-1)/r)-1),0);return n+(a-n*r)/(Math.min((n+1)*r,t-1)-n*r)}var Dn=1e4,Mi=20,Ei=4,Si=4,Ai="The surface is shown coarse",Ti="A part of the surface is shown coarse",_i="A time step c\
annot be shown",Ae=class{times=new Map;now;constructor(e=()=>performance.now()){this.now=e}add(e){this.times.set(e,this.
now())}has(e){return this.now()-(this.times.get(e)??-1/0)<Dn}},Oe=class{source;taker;running=new Map;jobs=[];failed=new Ae;constructor(e,t){
this.source=e,this.taker=t}want(e){this.jobs=e;let t=new Set(e.map(String));for(let[r,n]of this.running)t.has(r)||(this.
running.delete(r),n.abort());this.next()}stop(){this.want([]),this.failed=new Ae}next(){for(let e of this.jobs){if(this.
running.size>=(this.source()?.atOnce??Ei))return;!this.running.has(String(e))&&!this.failed.has(String(e))&&this.run(e)}}async run(e){
let{taker:t}=this,r=this.source();if(!r)return;let[n,s,i]=e,o=new AbortController,{signal:c}=o,l=h=>n?t.tiles?.has(G(n),
h)??!1:t.parts.has(h);this.running.set(String(e),o);try{let h=await r.load(n,s,c,l,i);if(!c.aborted)for(let m of h)t.setPart(
m)}catch(h){c.aborted||this.fail(e,h)}c.aborted||(this.running.delete(String(e)),this.failed.has(String(e))||(this.jobs=
this.jobs.filter(h=>String(h)!==String(e))),this.next())}fail(e,t){let[r,n]=e;this.failed.add(String(e)),setTimeout(()=>this.
next(),Dn+Mi);let s=t.fault==="unreachable",i=r&&!s?G(r):void 0;this.taker.lack(Bn(r?Ti:_i,t),i,n)}};function Bn(a,e){let{
fault:t,message:r=String(e),detail:n=""}=e;return console.warn(r,n),t==="other"?r:`${a}: ${r}`}var dt=class{tiles;wholes;marks;given;formula=null;constructor(e,t){
this.given=e,this.tiles=new Oe(()=>this.source,t),this.wholes=new Oe(()=>this.source,t),this.marks=new Oe(()=>this.source,
t)}get source(){return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.
source?.hasMarks??!1}setHeader(e){this.stop(),this.formula=e.formula?new ut(e,e.formula):null}follow(e){return this.formula?.
follow(e)??!1}fit(){return this.formula?.fit()??!1}trajectory(e){return this.formula?.trajectory(e)??null}open(){let{taker:e}=this.
tiles;this.source?.open?.().catch(t=>e.lack(Bn(Ai,t)))}wantTiles(e,t){this.tiles.want(e.map(r=>[r,t]))}wantSteps(e){let t=this.
wholes.jobs.flatMap(([,n])=>n);if(e.every(n=>t.includes(n)))return;let r=[...new Set([...e,...t])].slice(0,e.length+Si);
this.wholes.want(r.map(n=>[null,[n]]))}wantMarks(e){let t=e.map(([r,n])=>[null,[n],r]);String(t)!==String(this.marks.jobs)&&
this.marks.want(t)}stop(){this.tiles.stop(),this.wholes.stop(),this.marks.stop()}};function Hn({header:a,camera:e,anchor:t,player:r,rows:n},s,i){let{geometry:o,constants:c}=a,l=e.state.focal_point,h=O(o.
frame,E(l,o.center)),m=c.anchorRange*2*e.height,u=p=>p.some(f=>Math.abs(f)>m);return{focus:l,anchor:u(E(h,t))?u(h)?h:[0,
0,0]:t,eye:e.eye,between:s[2],time:r.timeOf(s),clock:r.clock,still:!r.playing,density:i,pixel:2*e.height/Math.max(n*i,1)}}var Pi=-1e9,zn=500;function gt(a,e){if(a instanceof Float32Array&&!e.some(Boolean))return a;let t=new Float32Array(a.length);
for(let r=0;r<a.length;r+=1)t[r]=a[r]-e[r%3];return t}function Gn({shape:a,rows:e,columns:t}){return Float32Array.from({
length:2*a[0]*a[1]},(r,n)=>{let[s,{before:i,size:o}]=n%2?[Math.floor((n>>1)/a[1]),e]:[(n>>1)%a[1],t];return(s+i+.5)/o})}
function Wn(a,e){let t=Math.max(a.length,e.length);return Float32Array.from({length:2*t},(r,n)=>(n%2?e:a)[n>>1]??0)}function $n(a){
let e=Float32Array.from(a);for(let t=0;t<a.length;t+=3){let r=Math.hypot(a[t],a[t+1],a[t+2])||1;for(let n=t;n<t+3;n+=1)e[n]/=
r}return e}function bt(a,e){let t=a[0]?.length??0,r=new Float32Array(2*t),n=lr(e);return a.forEach((s,i)=>{for(let o=0;o<
t;o+=1){let c=n(s[o]);r[2*o+i]=Number.isFinite(c)?A(c,-zn,zn):Pi}}),r}function jn([a,e],[t,r]){let[n,s]=[Math.min(Math.floor(
t),e-2),Math.min(Math.floor(r),a-2)],[i,o]=[t-n,r-s],c=s*e+n,[l,h]=[Math.min(i,o),Math.max(i,o)],m=c+(i>=o?1:e);return[[
c,1-h],[m,h-l],[c+e+1,l]]}function yt(a,e){return a.reduce((t,[r,n])=>t+n*e(r),0)}var Ri=1-1e-7;function Yn(a,e){return Uint32Array.
from({length:4*e.length},(t,r)=>r%4<3?a[3*(r>>2)+r%4]:e[r>>2])}function Fe(a,e,t){return[t,a+Math.min(Math.max(e,0),Ri)]}
function Xn(a,[e,t]){let r=Math.floor(t),[n,s]=[t-r,e];return[1-n-s,n,s].map((i,o)=>[a[3*r+o],i])}var qn=180/Math.PI;var Li=1e-4;function ki(a){let[e,t,r]=[a-1,a-2,a-3];return[-(e*t*r)/6,a*t*r/2,-(a*e*r)/2,a*e*t/6]}function Kn(a,e){let t=a*(e-1),r=A(
Math.floor(t)-1,0,e-4);return[r,ki(t-r)]}function wr([a,e,t,r],{data:n,shape:s},i){let[o,c]=s,[l,h]=Kn((i[0]-a)/(t-a),c),
[m,u]=Kn((i[1]-e)/(r-e),o),p=[0,0,0];return u.forEach((f,d)=>{h.forEach((g,b)=>{for(let y=0;y<3;y+=1)p[y]+=g*f*n[3*((m+d)*
c+l+b)+y]})}),p}function vt(a,e,t){if(a.map&&!t)return null;let[r,n,s]=a.map&&t?wr(a.map,t,e):e,i=[Math.atan2(n,r),Math.
atan2(s,Math.hypot(r,n))];return i.every(Number.isFinite)?[i[0]*qn,i[1]*qn]:null}function Jn(a,e,t,r){let[n,s]=[e,t];if(a.
map&&r){let{map:p,radius:f}=a,d=Li*(p[2]-p[0])/(Math.hypot(...t)||1),[g,b]=[-d,d].map(y=>wr(p,r,e.map((v,x)=>v+y*t[x])));
n=wr(p,r,e),s=b.map((y,v)=>f*(y-g[v])/(2*d))}let[i,o,c]=n,[l,h]=[Math.hypot(i,o)||1,Math.hypot(i,o,c)||1],m=(i*s[1]-o*s[0])/
l,u=(i*s[0]+o*s[1])/l;return[m,(l*s[2]-c*u)/h]}var Zn=8,Oi=4,Fi=10,Ni=.05,Ii=.25,ts=1e-6,Ci=.001;function Ui({scene:a,place:e},[t,r]){let{rows:n,columns:s,triangles:i}=a.
header.geometry;if(i){let p=[-t-r,t,r];return a.cornersAt(e).map(([f,d],g)=>[f,d+p[g]])}let[o,c]=[e[0]+t+s.before,e[1]+r+
n.before],[l,h]=[Math.floor(o),Math.floor(c)],[m,u]=[o-l,c-h];return[(1-m)*(1-u),m*(1-u),(1-m)*u,m*u].map((p,f)=>{let d=A(
l+(f&1),0,s.size-1);return[A(h+(f>>1),0,n.size-1)*s.size+d,p]})}function rs(a,e=[0,0]){let{scene:t,moment:r}=a,{slices:n}=t.
header,s=Ui(a,e),[i,o,c]=r,l=s.map(([p])=>p),h=(i===o?[i]:[i,o]).map(p=>t.texels(p,l)),m=i===o?[1]:[1-c,c],u=me(t.header)?
Vi(s.map((p,f)=>h[0](0,f))):s.map(()=>1);return p=>{let f=[0,0,0,0];return s.forEach(([,d],g)=>{let b=p+(p>n.lags.length?
-1:1)*n.lags.length,y=u[g]<0&&p>0?b:p;h.forEach((v,x)=>{m[x]&&v(y,g).forEach((w,M)=>{f[M]+=d*m[x]*w*(M<3?u[g]:1)})})}),f}}
function Vi(a){let e=[0,0,0];return a.map(([t,r,n])=>{let s=R(e,[t,r,n])<0?-1:1;return e=P(e,[t,r,n],s),s})}function Di(a,e,t,r,n){
let[s,i]=[a(0).slice(0,3),0],o=a(t+1)[3],c=Math.min(o,e[e.length-1]),l=[];for(let h=0;h<e.length&&i<c;h+=1){let m=a(t+h+
1).slice(0,3);for(let u=1;u<=Zn;u+=1){let p=u/Zn,f=Math.min(i+p*(e[h]-i),c),d=(f-i)/(e[h]-i),g=s.map((b,y)=>b+d*(m[y]-b));
if(l.push(k(g,r*f*n)),f===c)break}[s,i]=[m,e[h]]}return l}function ns({scene:a,place:e,position:t}){let{image:r,geometry:n}=a.
header;if(!r)return l=>P(t,Z(n.frame,l));let{alongI:s,alongJ:i}=r,o=[Qn(s,e[0]),Qn(i,e[1])],c=Ne(a,e);return([l,h])=>{let m=[
es(s,o[0]+l),es(i,o[1]+h)];return m.some(Number.isNaN)?null:P(t,E(Ne(a,m),c))}}function Ie(a,e){return P(Ne(a,e),a.header.
geometry.center)}function Ne(a,e){let{data:t}=a.part("position"),r=a.cornersAt(e),n=[0,1,2].map(s=>yt(r,i=>t[3*i+s]));return Z(
a.header.geometry.frame,n)}function Bi(a,e){let{shape:t,triangles:r}=a.header.geometry;if(r){let o=(c,l)=>Ne(a,Fe(Math.floor(
e[1]),c,l));return[E(o(1,0),o(0,0)),E(o(0,1),o(0,0))]}let[n,s]=e.map((o,c)=>A(o,.5,t[1-c]-1.5)),i=(o,c)=>Ne(a,[n+o,s+c]);
return[E(i(.5,0),i(-.5,0)),E(i(0,.5),i(0,-.5))]}function Qn(a,e){let t=Math.min(Math.floor(e),a.length-2);return a[t]+(e-t)*(a[t+1]-a[t])}function es(a,e){let t=a.findIndex(
r=>r>=e);return t<0||e<a[0]?NaN:t===0?0:t-1+(e-a[t-1])/(a[t]-a[t-1])}function Hi({scene:a,place:e,position:t},r,n,s){let{
geometry:i,image:o}=a.header,c=I(...Bi(a,e)),{height:l,ray:h}=n.at(t),m=Math.max(Math.abs(R(U(c),h)),Ni),u=2*l/s;if(o){let[
b,y]=[o.alongI,o.alongJ].map((x,w)=>{let M=Math.min(Math.floor(e[w]),x.length-2);return(x[M+1]-x[M])*o.stepSize[w]}),v=Math.
sqrt(F(c)/(b*y));return r.lod?Math.max(u/Math.sqrt(m),v):v}let p=i.extent/Number(r.resolution),f=R(h,n.at(n.state.focal_point).
ray),g=u*Math.sqrt(Math.max(f,Ii/m)/m)*Number(r.grain);return r.lod?r.fixed_grain?Math.max(g,p):g:p}function zi(a,e,t){let r=[],
[n,s]=[a,t];for(let i of e){let o=F(E(i,n));if(o>=s){s>0&&r.push(P(n,E(i,n),s/(o||1)));break}r.push(i),s-=o,n=i}return r}
function Mr(a){let{scene:e,position:t}=a,{slices:r,image:n,speed:s}=e.header,i=rs(a),[o,c,l]=i(0),h=[o,c,l],m=k(h,Ci*(n?
1/n.stepSize[0]:r.cell)/(F(h)||1)),u=F(h)>ts?E(ns(a)(m)??t,t):h;return k(U(u),i(2)[3]*s.typical)}function ss(a,e,t,r){let{
scene:n,position:s}=a,{slices:i,image:o}=n.header,c=rs(a),l=!me(n.header),h=c(0),m=[h[0],h[1],h[2]],u=ns(a),p=[],f=e.two_sided||
!l?i.sides:1;for(let w=0;w<f&&F(m)>ts;w+=1){let M=o?1:h[3]*i.unit,S=Di(c,i.lags,w*i.lags.length,w?1:-1,M).map(u),T=S.findIndex(
L=>L===null);p.push(S.slice(0,T<0?void 0:T))}let d=Number(e.samples),g=lt(n.header,e,!0)?2*d-1:d,b=f===2?Math.floor(g/2):
g-1,y=Number(e.spacing)*Hi(a,e,t,r),v=w=>{let[M=[],_=[]]=p.map(S=>zi(s,S,w));return[...M.reverse(),s,..._]};return{path:v(
Oi*Math.max(b,Fi)*y),sampled:v(b*y),directed:l,velocity:Mr(a)}}var Gi=8,Wi=1e-6,$i=.001,ji=89.99,Yi=a=>a-360*Math.round(a/360);function Er([a,e]){return[[a,e],[a+1,e],[a,e+1],[a+1,e+1]]}
function xt({header:a},e){return e.map((t,r)=>A(Math.floor(t),0,a.geometry.shape[1-r]-2))}var as=([a,e])=>[(1-a)*(1-e),a*
(1-e),(1-a)*e,a*e];function is(a,e,[t,r],n){let{earth:s}=a.header,i=Er(e).map(d=>s&&vt(s,Ie(a,d),n));if(i.some(d=>!d||Math.
abs(d[1])>ji))return null;let[o,c,l,h]=i.map(d=>[Yi(d[0]-t),d[1]-r]),[m,u]=[c,l].map(d=>[d[0]-o[0],d[1]-o[1]]),p=Math.max(
...[...m,...u].map(Math.abs)),f=m[0]*u[1]-m[1]*u[0];return!f||[0,1].some(d=>Math.abs(o[d]-c[d]-l[d]+h[d])>$i*p)?null:[(o[1]*
u[0]-o[0]*u[1])/f,(o[0]*m[1]-o[1]*m[0])/f]}function os(a,e,t,r){let{earth:n,geometry:s}=a.header,i=n&&!s.triangles&&vt(n,
t,r);if(!i)return e;let o=xt(a,e);for(let c=0;c<Gi;c+=1){let l=is(a,o,i,r);if(!l)return e;let h=l.map(u=>Math.abs(u-.5)>
.5+Wi?u:0),m=xt(a,o.map((u,p)=>u+h[p]));if(String(m)===String(o))return o.map((u,p)=>u+A(l[p],0,1));o=m}return e}function cs(a,e){
let{earth:t,geometry:r}=a.header;if(!t||r.triangles)return a.cornersAt(e);let n=xt(a,e),s=as(e.map((i,o)=>i-n[o]));return Er(
n).map(([i,o],c)=>[o*r.shape[1]+i,s[c]])}function ls(a,e){let{scene:t,place:r,position:n}=a,{earth:s,geometry:i}=t.header,
o=s&&vt(s,n,e);if(!o)return null;let c=u=>Jn(s,u.position,Mr(u),e),l=xt(t,r);if(i.triangles||!is(t,l,o,e))return c(a);let h=as(
r.map((u,p)=>u-l[p])),m=Er(l).map(u=>c({...a,place:u,position:Ie(t,u)}));return[0,1].map(u=>m.reduce((p,f,d)=>p+h[d]*f[u],
0))}var Xi=16;function ms(a,e,t,r,[n,s]){let{layer:i,coordinate:o,triangle:c}=a,{geometry:l}=i.scene.header,h=l.triangles?Fe(
c,...o):qi(l,...o),m=t.ray(n,s),u=hs(i.scene,h,m)[1],[p,f]=hs(i.scene,u,m),d=os(i.scene,f,p,e.parts.get("lonlat")),g=l.triangles?
d:Ki(e.header,i,d);return{point:{position:p,index:g,values:Ji(i.scene,r,d)},layer:i,place:d}}function qi({rows:a,columns:e,
shape:t},r,n){let s=(i,{size:o,before:c},l)=>A(i*o-.5-c,0,l-1);return[s(r,e,t[1]),s(n,a,t[0])]}function Ki(a,{key:e},[t,
r]){let{pyramid:n,geometry:s,mesh:i,formula:o}=a,[c,l,h]=e,[m,u]=n?.shapes[0]??s.shape,p=i.tileCells*(n?.tileBlocks??0),
f=o?2**(n?.depth??0):1,d=(g,b,y)=>ft(g+b*p,c,y)/f;return[d(t,h,u),d(r,l,m)]}function hs(a,e,[t,r]){let{geometry:n}=a.header,
{data:s}=a.part("position"),i=a.cornersAt(e).map(([x])=>x),[o,c,l]=i.map(x=>P(Z(n.frame,[...s.subarray(3*x,3*x+3)]),n.center)),
[h,m]=[E(c,o),E(l,o)],u=I(h,m),p=P(t,r,R(u,E(o,t))/R(u,r)),f=E(p,o),[d,g]=[I(f,m),I(h,f)].map(x=>R(x,u)/R(u,u));if(!(Math.
max(Math.abs(d),Math.abs(g))<Xi)){let x=Ie(a,e);return[P(t,r,R(E(x,t),r)/R(r,r)),e]}if(n.triangles)return[p,Fe(Math.floor(
e[1]),d,Math.max(g,0))];let[b,y]=n.shape,v=(x,w)=>{let[M,_,S]=i.map(x);return A(M+d*(_-M)+g*(S-M),0,w-1)};return[p,[v(x=>x%
y,y),v(x=>Math.floor(x/y),b)]]}function Ji(a,e,t){let{header:r,parts:n}=a,{scalars:s,geometry:i}=r,o=cs(a,t),c=i.triangles?
Math.floor(t[1]):o[0][0],[l,h,m]=e,u={},p=s.choices.map((f,d)=>({...f,number:d}));for(let f of[s,...p]){let d=a.scalarParts(
l,h,f),[g,b]=d.map(v=>n.get(v)?.data);if(f.name===null||f.name in u||!g||!b)continue;let y=v=>g[v]+m*(b[v]-g[v]);u[f.name]=
f.flat?y(c):yt(o,y)}return u}var Zi=3,us=5;function ps({shape:a,triangles:e},t,r,n){let[s,i]=t.shape,o=new Int8Array(s*i).fill(e?0:Math.log2(n));for(let c=0;c<
r.length;c+=3){if(Number.isFinite(r[c]))continue;let[l,h]=[Math.floor(c/3/a[1]),c/3%a[1]];for(let m of[Math.floor((l-1)/
n),Math.floor(l/n)])for(let u of[Math.floor((h-1)/n),Math.floor(h/n)])m>=0&&m<s&&u>=0&&u<i&&(o[m*i+u]=0)}return o}function fs({
shape:a,data:e},t,r,n,s){let[i,o]=a,c={...t.sight(r),planes:t.planes},l=new Int8Array(i*o).fill(-1),h=[1,1,-1,-1];for(let m=0;m<
l.length;m+=1){let[u,p]=[Math.floor(m/o),m%o],f=e.subarray(us*m,us*(m+1));if(n.some(([b,y,v])=>u>=b&&u<b+v&&p>=y&&p<y+v)||
!yr(c,f))continue;let g=Math.floor(Math.log2(Zi/vr(c,f)));l[m]=Math.min(Math.max(g,0),s[m]),Qi(t,f).forEach((b,y)=>h[y]=
y<2?Math.min(h[y],b):Math.max(h[y],b))}return{levels:l,box:h}}function Qi(a,[e,t,r,n]){let[s,i,o]=a.axes,{parallel:c,position:l,
focal_point:h}=a.state,m=E([e,t,r],c?h:l),u=[-n,n].map(d=>a.at(P([e,t,r],o,d)).height);if(!(u[0]>0))return[-1,-1,1,1];let[
p,f]=[-n,n].map(d=>[R(m,s)/a.aspect,R(m,i)].map((g,b)=>u.map(y=>(g+d/(b?1:a.aspect))/y)));return[...p.map(d=>Math.min(...d)),
...f.map(d=>Math.max(...d))]}var eo=1024,ds=["u_places","u_depths","u_colours","u_strides"].map(a=>de.indexOf(a)),wt=class{width=0;height=0;graphics;target=null;key="";layers=[];seen=[];squares=0;constructor(e){
this.graphics=e}draw({layers:e,camera:t,anchor:r,width:n,height:s}){let i=e.map(({scene:p,covered:f})=>[p.number,p.version,
f]),o=JSON.stringify([i,t.state,t.aspect,r,n,s]);if(o===this.key)return;Object.assign(this,{key:o,layers:e,width:n,height:s});
let c=this.graphics.context,{frames:l}=this.make(n,s),[{scene:h}]=e,m=Math.min(...e.map(({key:[p]})=>p))+Math.log2(h.header.
mesh.tileCells);this.seen=e.map(({scene:p,covered:f,key:[d]})=>{let g=p.doublings.map(b=>Math.max(Math.min(b,m-d),0));return fs(
p.blocks,t,s,f,g)}),this.sendStrides(),c.bindFramebuffer(c.FRAMEBUFFER,l[0]),c.viewport(0,0,n,s),c.disable(c.SCISSOR_TEST),
c.enable(c.DEPTH_TEST),c.depthFunc(c.LESS),c.disable(c.BLEND),c.clearBufferuiv(c.COLOR,0,[0,0,0,0]),c.clear(c.DEPTH_BUFFER_BIT);
let u=z(h.header.geometry,t,r);h.bodies.hide(u,r),h.bodies.seeThrough(()=>this.triangles(h.programs("place"),u,r),!1)}triangles(e,t,r,n={}){
let{graphics:s,layers:i,seen:o}=this,c=s.context,{mesh:l,pyramid:h,geometry:m}=i[0].scene.header,[u,p]=h?.shapes[0]??m.shape;
this.bind(),c.bindVertexArray(null),i.forEach(({scene:f,key:[d,...g]},b)=>{let{levels:y}=o[b],{columns:v,rows:x,shape:w,
triangles:M}=f.header.geometry,[_,S]=g.map(L=>L*l.tileCells*(h?.tileBlocks??0)*2**d);f.bindNodes(r),s.programs.use(e,{...n,
u_matrix:t,u_layer:b+1,u_blocks:y.reduce((L,N,H)=>L|(N<0?0:1<<H),0),u_part:[S,_,d],u_lastNode:[p-1,u-1,this.squares],u_closed:[
Number(m.periodic[1]),Number(m.periodic[0])],u_blockCells:l.tileCells,u_slicesSize:[v.size,x.size],u_padding:[v.before,x.
before]}),M&&c.drawArrays(c.TRIANGLES,0,f.part("triangles").data.length);let T=f.blocks.shape[1];y.forEach((L,N)=>{if(L<
0||M)return;let H=[N%T,Math.floor(N/T)].map(C=>C*l.tileCells),[K,se]=H.map((C,J)=>Math.ceil(Math.min(l.tileCells,w[1-J]-
1-C)/2**L));s.programs.use(e,{u_block:[...H,L,K]}),c.drawArrays(c.TRIANGLES,0,6*K*se)})})}sum(e,t,r,n){let{graphics:s,width:i,
height:o,target:c}=this,l=s.context,h=o-t-r;l.bindFramebuffer(l.FRAMEBUFFER,c?.frames[1]??null),l.viewport(0,0,i,o),l.enable(
l.SCISSOR_TEST),l.disable(l.DEPTH_TEST),l.disable(l.BLEND),l.bindVertexArray(null),this.layers.forEach(({scene:m},u)=>{let[
p,f,d,g]=this.seen[u].box.map((M,_)=>(.5+.5*M)*(_%2?o:i)),[b,y]=[Math.max(Math.floor(p),0),Math.max(Math.floor(f),h)],[v,
x]=[Math.min(Math.ceil(d),i)-b,Math.min(Math.ceil(g),h+r)-y];if(v<=0||x<=0)return;l.scissor(b,y,v,x);let w=n(m);this.bind(),
s.programs.use(e,{...w,u_layer:u+1}),l.drawArrays(l.TRIANGLES,0,3)}),l.readPixels(0,0,1,1,l.RGBA,l.UNSIGNED_BYTE,new Uint8Array(
4)),l.bindFramebuffer(l.FRAMEBUFFER,null)}show(e){let t=this.graphics.context;this.bind(),t.bindVertexArray(null),this.graphics.
programs.use(e,{u_bottom:0}),t.drawArrays(t.TRIANGLES,0,3)}at(e,t){let{graphics:r,target:n,layers:s}=this,i=r.context,[o,
c]=[(.5+.5*e)*this.width,(.5+.5*t)*this.height],l=A(Math.floor(o-.5),0,this.width-2),h=A(Math.floor(c-.5),0,this.height-
2),m=new Uint32Array(16);i.bindFramebuffer(i.FRAMEBUFFER,n?.frames[0]??null),i.readPixels(l,h,2,2,i.RGBA_INTEGER,i.UNSIGNED_INT,
m),i.bindFramebuffer(i.FRAMEBUFFER,null);let u=+(o>=l+1)+2*+(c>=h+1),p=4*([u,u^1,u^2,u^3].find(g=>m[4*g+3])??u),[f,d]=new Float32Array(
m.buffer,4*p,2);return m[p+3]?{layer:s[m[p+3]-1],coordinate:[f,d],triangle:m[p+2]}:null}dispose(){let{graphics:e,target:t}=this;
for(let r of t?.textures??[])e.free("Texture",r);for(let r of t?.frames??[])e.free("Framebuffer",r);this.target=null,this.
key=""}sendStrides(){let{layers:e,seen:t,target:r}=this,n=this.graphics.context,[{scene:s}]=e,{pyramid:i,geometry:o}=s.header,
c=o.triangles?[1,1]:i?.blocks[0]??s.blocks.shape;this.squares=Math.max(Math.ceil(Math.log2(Math.max(...c)/eo)),0);let l=2**
-this.squares,[h,m]=c.map(p=>Math.ceil(p*l)),u=new Uint8Array(h*m);e.forEach(({scene:p,key:[f,...d]},g)=>{let b=p.blocks.
shape[1],y=2**f*l;t[g].levels.forEach((v,x)=>{if(v<0||o.triangles)return;let[[w,M],[_,S]]=[Math.floor(x/b),x%b].map((T,L)=>{
let N=(T+d[L]*(i?.tileBlocks??0))*y;return[Math.floor(N),Math.min(Math.ceil(N+y),[h,m][L])]});for(let T=w;T<M;T+=1)for(let L=_+
T*m;L<S+T*m;L+=1)u[L]=Math.max(u[L],f+v)})}),n.activeTexture(n.TEXTURE0+ds[3]),n.bindTexture(n.TEXTURE_2D,r?.textures[3]??
null),n.pixelStorei(n.UNPACK_ALIGNMENT,1),n.texImage2D(n.TEXTURE_2D,0,n.R8UI,m,h,0,n.RED_INTEGER,n.UNSIGNED_BYTE,u)}make(e,t){
let{target:r,graphics:n}=this;if(r&&r.width>=e&&r.height>=t)return r;let s=n.context,{key:i}=this,o={width:Math.max(e,r?.
width??0),height:Math.max(t,r?.height??0)};this.dispose();let c=[s.RGBA32UI,s.DEPTH_COMPONENT24,s.RGBA8,0].map(h=>{let m=n.
counted(s.createTexture());return s.bindTexture(s.TEXTURE_2D,m),h&&s.texStorage2D(s.TEXTURE_2D,1,h,o.width,o.height),s.texParameteri(
s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,s.NEAREST),m}),l=[[c[0],c[1]],
[c[2]]].map(h=>{let m=n.counted(s.createFramebuffer());return s.bindFramebuffer(s.FRAMEBUFFER,m),h.forEach((u,p)=>{let f=p?
s.DEPTH_ATTACHMENT:s.COLOR_ATTACHMENT0;s.framebufferTexture2D(s.FRAMEBUFFER,f,s.TEXTURE_2D,u,0)}),m});return this.key=i,
this.target={frames:l,textures:c,...o}}bind(){let e=this.graphics.context;ds.forEach((t,r)=>{e.activeTexture(e.TEXTURE0+
t),e.bindTexture(e.TEXTURE_2D,this.target?.textures[r]??null)}),e.activeTexture(e.TEXTURE0+de.length)}};function gs(a,e){var t=e[0],r=e[1],n=e[2],s=e[3],i=e[4],o=e[5],c=t*s-r*n;return c?(c=1/c,a[0]=s*c,a[1]=-r*c,a[2]=-n*c,a[3]=
t*c,a[4]=(n*o-s*i)*c,a[5]=(r*i-t*o)*c,a):null}function bs(a){return a[0]*a[3]-a[1]*a[2]}function ys(a,e,t){var r=e[0],n=e[1],
s=e[2],i=e[3],o=e[4],c=e[5],l=t[0],h=t[1],m=t[2],u=t[3],p=t[4],f=t[5];return a[0]=r*l+s*h,a[1]=n*l+i*h,a[2]=r*m+s*u,a[3]=
n*m+i*u,a[4]=r*p+s*f+o,a[5]=n*p+i*f+c,a}var ro=14,no=40,so=256;function vs(a,e){a?.clearRect(0,0,e.width,e.height),a?.drawImage(e,0,0)}var ao=(a,e)=>a.getContext(
"2d",{alpha:e}),Mt=class{viewer;content;graphics;canvas;pen;last=document.createElement("canvas");lastPen;lastCamera=null;coarse=document.
createElement("canvas");coarsePen;front=document.createElement("canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed=4;isCoarse=!1;constructor(e,t){
this.viewer=e,this.content=t,this.graphics=e.graphics,this.canvas=e.canvas;let{canvas:r,last:n,coarse:s}=this,i=[r,n,s].
map(o=>ao(o,e.isClear??!1));[this.pen,this.lastPen,this.coarsePen]=i}restart(e=!1){e||(this.lastCamera=null),this.version+=
1,this.rowsDone=0}refine(){(this.rowsDone>=this.canvas.height||!this.content.isComing)&&(this.rowsDone=0),this.isRefined=
!0}resize(e,t){let{canvas:r,coarse:n,last:s}=this;n.width=r.width,n.height=r.height,this.coarsePen?.drawImage(r,0,0),r.width=
s.width=e,r.height=s.height=t,n.width>1&&this.pen?.drawImage(n,0,0,e,t)}dispose(){for(let e of[this.last,this.coarse,this.
front])e.width=e.height=0}draw(e,t,r){let n=this.isMoving;if(this.draftVersion!==this.version)return this.draft(e,t,n);if(n)
return!1;let s=!1;do s=this.strip(e,t)&&!this.isRefined;while(!s&&performance.now()<r);return s}get isMoving(){return this.
viewer.player.playing||this.viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(e){this.isRefined=
!1,this.layers=this.content.arrange(e)}draft(e,t,r){let{width:n,height:s}=this.canvas,i=Number(this.viewer.settings.samples),
o=r?this.graphics.waiting.size+1:1;this.arrange(t);let c=e.price*this.factor(i),l=this.viewer.player.playing&&!this.viewer.
isHeld,h=xn(c,this.fixed,n*s,i,l),m=Math.max(h/o,ro),u=vn(c,this.fixed,n*s,i,m),p=Math.max(Math.round(n*u.scale),1),f=Math.
max(Math.round(s*u.scale),1);this.draftVersion=this.version;let d=u.scale<1?this.reuse():null;if(!d?.covers){let b=performance.
now();this.place(t,p,f);let y=this.sum(e,t,0,f,u.samples);this.show(t,!1),this.fixed+=.5*(A(performance.now()-b-y,.5,500)-
this.fixed)}d&&this.pen&&(this.pen.imageSmoothingEnabled=!d.shifts,this.pen.setTransform(...d.matrix),vs(this.pen,this.last),
this.pen.setTransform(1,0,0,1,0,0)),this.isCoarse=u.scale<1||u.samples<i;let g=!this.isCoarse&&!this.content.smooth;return g&&
this.complete(),this.drawLines(t),g&&!this.isRefined}strip(e,t){let{width:r,height:n}=this.canvas,s=Number(this.viewer.settings.
samples);if(this.rowsDone>=n&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(t),this.isRefined))return!1;this.place(
t,r,n);let i=e.price*this.factor(s),o=Math.min(n-this.rowsDone,wn(no,i,r,s));return this.sum(e,t,this.rowsDone,o,s),this.
rowsDone+=o,this.rowsDone<n?!1:(this.show(t,this.content.smooth),this.complete(),this.drawLines(t),!0)}drawLines(e){let{
front:t,frontPen:r,graphics:n}=this,{camera:s,ratio:i}=this.viewer,{scene:o}=this.content,{width:c,height:l}=this.canvas;
if(!o||!s||!r)return;let{earth:h,bodies:m}=o;if(!h.lines.length&&!m.labels.length)return;let{state:u,aspect:p}=s,f=JSON.
stringify([u,p,c,l,h.lines,h.version]);if(f!==this.frontLook){let{anchor:d}=this.viewer.view(e,i),{canvas:g}=n;g.width<c&&
(g.width=c),g.height<l&&(g.height=l),t.width=c,t.height=l,h.drawLines({camera:s,anchor:d,width:c,height:l,ratio:i},()=>{
let b=g.height-l;r.drawImage(g,0,b,c,l,0,0,c,l)}),m.drawLabels(r,{camera:s,anchor:d,width:c,height:l,ratio:i}),this.frontLook=
f}this.pen?.drawImage(t,0,0)}complete(){let{camera:e,player:t}=this.viewer;this.rowsDone=this.canvas.height,this.isCoarse=
!1,this.draftVersion=this.version,vs(this.lastPen,this.canvas),e&&!t.playing&&(this.lastCamera=new fe(e.state,e.limits,e.
flat,e.aspect))}reuse(){let{lastCamera:e}=this,{camera:t}=this.viewer,{scene:r}=this.content;if(!r?.header.geometry.planar||
!t||!e||!t.state.parallel||!e.state.parallel)return null;let{geometry:n}=r.header,s=E(t.state.focal_point,n.center),i=O(
n.frame,s),[o,c]=[e,t].map(l=>z(n,l,i));return co(o,c,this.canvas.width,this.canvas.height)}factor(e){let{settings:t,player:r}=this.
viewer;return t.motion!=="off"||r.varies&&r.playing?Mn(e):1}placeAt(e,t,r){let{places:n}=this.content;return this.place(
e,n?.width||this.canvas.width,n?.height||this.canvas.height),n?.at(t,r)??null}place(e,t,r){let{viewer:n,layers:s,content:i}=this,
{camera:o}=n;if(!o||!s.length)return;let{anchor:c}=n.view(e,this.density(r));i.places?.draw({layers:s,camera:o,anchor:c,
width:t,height:r})}density(e){return this.viewer.ratio*e/this.canvas.height}sum(e,t,r,n,s){let{places:i,scene:o}=this.content,
{camera:c}=this.viewer;if(!i||!o||!c)return 0;let{width:l,height:h}=i,m=this.viewer.view(t,this.density(h)),u=s!==this.viewer.
settings.samples||h!==this.canvas.height,p=g=>(g.bindNodes(m.anchor),g.bindTextures(t[0],t[1]),{...this.values(g,o,c,m,s,
u),...fn(g.header.geometry,c,m.anchor,l,h)});e.warm||i.sum(e,r,1,p),e.warm=!0;let f=performance.now();i.sum(e,r,n,p);let d=performance.
now()-f;return e.price=En(e.price,d,l*n,s,this.factor(s)),d}show(e,t){let{places:r}=this.content;if(!r)return;let{width:n,
height:s}=r,{canvas:i}=this.graphics;i.width<n&&(i.width=n),i.height<s&&(i.height=s);let o=t?so:s;for(let c=0;c<s;c+=o)this.
render(e,c,Math.min(o,s-c),t)}render(e,t,r,n){let{graphics:s,viewer:i}=this,{camera:o}=i,{scene:c,places:l}=this.content;
if(!o||!c||!l)return;let h=s.context,{width:m,height:u}=l,p=i.view(e,this.density(u));n?s.bindSmooth(m,r):h.bindFramebuffer(
h.FRAMEBUFFER,null),h.viewport(0,-t,m,u),h.enable(h.SCISSOR_TEST),h.scissor(0,0,m,r),h.enable(h.DEPTH_TEST),h.depthFunc(
h.LESS),h.disable(h.BLEND),h.disable(h.CULL_FACE);let[f,d,g]=c.header.background??[1,1,1];h.clearColor(f,d,g,i.isClear?0:
1),h.clear(h.COLOR_BUFFER_BIT|h.DEPTH_BUFFER_BIT);let b={camera:o,anchor:p.anchor,width:m,height:u,ratio:i.ratio};c.earth.
drawGround(b);let{bodies:y}=c;y.draw(b,"opaque"),y.seeThrough(()=>{if(!n)return l.show(c.programs("surface"));let v=z(c.
header.geometry,o,p.anchor);l.triangles(c.programs("smooth"),v,p.anchor,{u_bottom:t})}),this.drawArrows(e,p,m,u),y.draw(
b,"clear"),c.marks.draw({...b,ratio:p.density},i.settings,e),n&&s.copySmooth(m,r),this.copy(m,u,t,r)}drawArrows(e,t,r,n){
let{camera:s,settings:i}=this.viewer,{scene:o}=this.content;if(!o||!s||!ke(o.header,i))return;let c={...s.sight(n/t.density),
planes:s.planes},l=n!==this.canvas.height,h=this.layers.map(m=>m.scene);for(let[m,u]of o.arrows.share(c,i,h)){let{arrows:p,
header:f}=m,d=p.program(i,ht(f,i,t));if(!d||!u.length)continue;m.bindTextures(e[0],e[1]);let g=m.scalarParts(e[0],e[1]),
b=this.values(m,o,s,t,Number(i.samples),l);p.draw(d,u,g,t.anchor,{...b,u_picture:[r,n]})}}values({header:e},{bodies:t},r,n,s,i){
let{settings:o}=this.viewer,{columns:c,rows:l}=e.geometry,h=e.scalars.name!==null&&ke(e,o)&&o.arrow_color==="scalars";return{
...kn(e,{...o,samples:s},n),...i?Sn(o,s,n.density):{},u_matrix:z(e.geometry,r,n.anchor),u_mapped:e.scalars.name!==null&&
!h,u_plain:h,u_flat:!!e.scalars.flat,u_padding:[c.before,l.before],u_colour:e.colour,u_lit:e.lighting,u_ground:e.background??
[1,1,1],u_opacity:t.areBehind?1:e.opacity,u_toEye:O(e.geometry.frame,k(r.axes[2],-1))}}copy(e,t,r,n){let{pen:s}=this;if(!s)
return;let{canvas:i}=this.graphics,o=i.height-n,[c,l]=[this.canvas.width,this.canvas.height/t];if(s.imageSmoothingEnabled=
c!==e||l!==1,s.imageSmoothingEnabled){let{coarse:m,coarsePen:u}=this;m.width=e,m.height=n,u?.drawImage(i,0,o,e,n,0,0,e,n),
[i,o]=[m,0]}let h=(t-r-n)*l;s.clearRect(0,h,c,n*l),s.drawImage(i,0,o,e,n,0,h,c,n*l)}},io=4,oo=.3,Sr=1e-6,xs=(a,e)=>ys([0,
0,0,0,0,0],a,e),ws=a=>gs([0,0,0,0,0,0],a);function co(a,e,t,r){let[n,s]=[t/2,r/2],i=M=>xs([n,0,0,-s,n,s],[M[0],M[1],M[4],
M[5],M[12],M[13]]),o=xs(i(e),ws(i(a))),c=Math.abs(bs(o));if(!(c>oo**2&&c<io**2))return null;let[l,h,m,u,p,f]=ws(o),d=([M,
_])=>Math.abs((l*M+m*_+p)/n-1)<1+Sr&&Math.abs((h*M+u*_+f)/s-1)<1+Sr,g=[[0,0],[t,0],[0,r],[t,r]].every(d),[b,y,v,x]=o,w=Math.
abs(b-1)+Math.abs(x-1)+Math.abs(y)+Math.abs(v)<Sr;if(w)for(let M of[4,5])o[M]=Math.round(o[M]);return{matrix:o,covers:g,
shifts:w}}var Tt=4,_t=class{surface;limits;sums;whole=[[]];last=null;constructor(e,t){this.surface=e,this.limits=t;let r=0;this.sums=
Float64Array.from({length:e.corners.length/Tt},(n,s)=>r+=this.area(Ar(s)))}seen(e,t){return(!this.last||!this.covers(this.
last.wanted,[e,t]))&&(this.last={wanted:[e,t],seeds:this.make([e,t])}),this.last.seeds}position(e,t){let{nodes:r,corners:n}=this.
surface;return Ce(r,n.subarray(Tt*e,Tt*(e+1)),t,3)}point(e){let{frame:t,center:r}=this.surface.geometry;return P(Z(t,e),
r)}covers([e,t],[r,n]){let{closer:s}=this.limits;return this.cornersOf(r).every(i=>s*t*At(e,i)<=n*At(r,i)&&this.sees(e,i,
0))}cornersOf({planes:e}){let{center:t,extent:r}=this.surface.geometry,n=c=>e[c].slice(0,3),s=I(n(0),n(2)),i=.5*r*F(s);return[
0,1].flatMap(c=>[2,3].flatMap(l=>[-1,1].map(h=>[c,l,h]))).map(([c,l,h])=>{let[m,u]=[n(c),n(l)],p=P(k(I(u,s),-e[c][3]),I(
s,m),-e[l][3]),f=I(m,u);return k(P(p,f,R(s,t)+h*i),1/R(f,s))})}sees(e,t,r){let n=r+this.limits.around*e.pixels*At(e,t);return e.
planes.every(s=>R(s,t)+s[3]>=-n*F(s))}make(e){let[t,r]=e,{limits:n,sums:s,whole:i}=this,{extent:o,center:c}=this.surface.
geometry,l=s[s.length-1]??0,h=t.eye?Math.max(F(E(c,t.eye))-.5*o,0):1,m=n.closer*r*Tr(t,h),u=o,p=i[0],f=null;for(let d=0;d<
n.mostOctaves;d+=1){let g=n.candidateArea*u**2;if(l<=n.mostCandidates*g)i[d+1]??=this.grown(p,this.spread(d,g),u),p=i[d+
1];else{f??=Array.from(s,(y,v)=>Ar(v)),f=this.divided(f.filter(y=>this.isNeeded(y,e,u)),g);let b=f.flatMap(y=>{let v=ce(
y.key+d);return St(v)*g<this.area(y)?[this.candidate(y,v)]:[]});if(p=this.grown(p,b,u),!f.length)break}if(u<=m)break;u*=
n.octave}return p.filter(d=>{let g=this.point(d.position);return d.radius>=n.closer*r*At(t,g)&&this.sees(t,g,0)})}spread(e,t){
let{sums:r}=this,n=ce(e+Et),s=0;return Array.from({length:Math.floor((r[r.length-1]??0)/t)},(i,o)=>{let c=ce(n+o),l=(o+St(
c))*t;for(;s<r.length-1&&r[s]<=l;)s+=1;return this.candidate(Ar(s),c)})}candidate({cell:e,low:t,size:r},n){let s=ce(n+Et),
i=ce(s+Et),o=[t[0]+r[0]*St(s),t[1]+r[1]*St(i)];return{cell:e,place:o,position:this.position(e,o),radius:1/0}}grown(e,t,r){
let n=r/this.limits.octave,s=new Pt(n);for(let l of e)s.add(l.position);for(let l of t)l.radius=s.distance(l.position);let i=t.
filter(({radius:l})=>l>=r).sort((l,h)=>h.radius-l.radius),o=new Pt(n),c=i.filter(l=>(l.radius=Math.min(l.radius,o.distance(
l.position)),l.radius<r?!1:(o.add(l.position),!0)));return[...e,...c]}isNeeded(e,[t,r],n){let{octave:s,closer:i,aroundRadii:o}=this.
limits,{cell:c,low:l,size:h}=e,m=this.point(this.position(c,[l[0]+.5*h[0],l[1]+.5*h[1]])),[u,p]=this.sides(e),f=.5*(F(u)+
F(p)),d=Math.max(Ss(t,m)-f,0);return!(n<s*i*r*Tr(t,d))&&this.sees(t,m,f+o*n)}divided(e,t){let r=e.filter(i=>this.area(i)>
t);if(!r.length)return e;let n=r.map(i=>{let[o,c]=this.sides(i),l=F(c)>F(o)?1:0,h=[...i.size];h[l]*=.5;let m=[...i.low];
return m[l]+=h[l],[{...i,size:h,key:ce(i.key+Et)},{...i,size:h,low:m,key:ce(i.key+lo)}]}),s=e.filter(i=>this.area(i)<=t);
return this.divided([...s,...n.map(([i])=>i),...n.map(([,i])=>i)],t)}sides({cell:e,low:t,size:r}){let n=(s,i)=>this.position(
e,[t[0]+r[0]*s,t[1]+r[1]*i]);return[E(n(1,.5),n(0,.5)),E(n(.5,1),n(.5,0))]}area(e){return F(I(...this.sides(e)))}};function Ce(a,e,[
t,r],n){let s=[(1-r)*(1-t),(1-r)*t,r*(1-t),r*t],i=new Array(n).fill(0);for(let o=0;o<Tt;o+=1)for(let c=0;c<n;c+=1)i[c]+=
s[o]*a[n*e[o]+c];return i}var Pt=class{most;cubes=new Map;constructor(e){this.most=e}cube(e){return e.map(t=>Math.floor(
t/this.most))}add(e){let t=Es(...this.cube(e)),r=this.cubes.get(t);r?r.push(e):this.cubes.set(t,[e])}distance(e){let[t,r,
n]=this.cube(e),s=this.most;for(let i=0;i<27;i+=1){let o=Es(t+i%3-1,r+Math.floor(i/3)%3-1,n+Math.floor(i/9)-1);for(let c of this.
cubes.get(o)??[])s=Math.min(s,F(E(e,c)))}return s}},Et=2654435769,lo=2246822507,ho=[739982445,695872825],Ms=15;function Es(a,e,t){
return Math.imul(a,2376512323)^Math.imul(e,3625334849)^Math.imul(t,3407524639)}function ce(a){let e=a>>>0;for(let t of ho)
e=Math.imul(e^e>>>Ms,t)>>>0;return(e^e>>>Ms)>>>0}var St=a=>a/2**32;function Ar(a){return{cell:a,low:[0,0],size:[1,1],key:ce(
a)}}var Ss=({eye:a},e)=>a?F(E(e,a)):1,Tr=({halfHeight:a,pixels:e},t)=>2*a/e*t,At=(a,e)=>Tr(a,Ss(a,e));var _s=[[0,3],[1,2],[2,3],[3,2],[4,3],[5,1]],As=4,mo=_s.reduce((a,[,e])=>a+e,0),uo=(a,e)=>a.length===e.length&&a.every((t,r)=>t===
e[r]),Ts=({tile:a})=>a?.[0]??1/0,Rt=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}program(e,t){let{shaders:r,geometry:n}=this.header;if(!ke(this.header,e))return null;
let s=t&&!n.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.get(r.arrowVertex,r.arrowFragment,...s)}share(e,t,r){
let{header:n,last:s}=this;this.seeds??=new _t(this.surface,n.constants.arrows);let i=this.seeds.seen(e,gr(n,t));if(s?.seeds===
i&&uo(r,s.layers))return s.shared;let{corners:o}=this.surface,c=i.map(({cell:m,place:u,radius:p})=>{let f=o.subarray(4*m,
4*m+4);return{corners:f,place:u,radius:p,cell:n.geometry.triangles?m:f[0]}}),l=new Map(r.map(m=>[m,[]])),h=[...r].sort((m,u)=>Ts(
m)-Ts(u));for(let m of c)for(let u of h){let p=u.tile?this.inTile(m,u,u.tile):m;if(p){l.get(u)?.push(p);break}}return this.
last={seeds:i,layers:r,shared:l},l}draw(e,t,r,n,s){let{graphics:i}=this,o=i.context;this.array??=this.make(),o.bindVertexArray(
this.array);let{name:c,low:l,high:h,log:m}=this.header.scalars,u=r.map(f=>this.parts.get(f)?.digest),p=JSON.stringify([n,
r,u,c,l,h,m]);(this.drawn?.placed!==t||this.drawn.key!==p)&&(o.bindBuffer(o.ARRAY_BUFFER,this.buffer),o.bufferData(o.ARRAY_BUFFER,
this.numbers(t,r,n),o.DYNAMIC_DRAW),this.drawn={placed:t,key:p}),i.programs.use(e,s),o.enable(o.BLEND),o.blendFuncSeparate(
o.SRC_ALPHA,o.ONE_MINUS_SRC_ALPHA,o.ZERO,o.ONE),o.depthMask(!1),o.drawArraysInstanced(o.TRIANGLE_STRIP,0,2*(this.header.
constants.arrows.pieces+1),t.length),o.depthMask(!0),o.disable(o.BLEND),o.bindVertexArray(null)}forget(){this.known=this.
seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.
array),this.array=this.buffer=null,this.forget()}inTile({corners:e,place:t,radius:r},n,[s,i,o]){let{geometry:c,pyramid:l,
mesh:h}=this.header;if(!l||c.triangles)return null;let m=h.tileCells*l.tileBlocks,[u,p]=n.header.geometry.shape,f=c.shape[1],
d=(v,x,w,M)=>{let _=l.shapes[0][x],S=Vn(ft(v,l.depth,_),s,_)-w*m,T=Math.min(Math.max(Math.floor(S),0),M-1);return S<0||S>
M?null:[T,S-T]},g=d(e[0]%f+t[0],1,o,p-1),b=d(Math.floor(e[0]/f)+t[1],0,i,u-1);if(!g||!b||n.parts.get("cells")?.data[b[0]*
(p-1)+g[0]]===0)return null;let y=b[0]*p+g[0];return{corners:[y,y+1,y+p,y+p+1],place:[g[1],b[1]],radius:r,cell:y}}make(){
let e=this.graphics.context,t=this.graphics.counted(e.createVertexArray());this.buffer=this.graphics.counted(e.createBuffer()),
e.bindVertexArray(t),e.bindBuffer(e.ARRAY_BUFFER,this.buffer);let r=0;for(let[n,s]of _s)e.enableVertexAttribArray(n),e.vertexAttribPointer(
n,s,e.FLOAT,!1,mo*As,r),e.vertexAttribDivisor(n,1),r+=s*As;return t}numbers(e,t,r){let{geometry:n,scalars:s}=this.header,
i=t.map(h=>this.parts.get(h)?.data??new Float32Array),o=bt(i,s),c=this.nodes,l=n.triangles?null:Gn(n);return Float32Array.
from(e.flatMap(({corners:h,place:m,radius:u,cell:p})=>{let[f,d]=m,[g,b,y,v]=Array.from(h,w=>[...c.subarray(3*w,3*w+3)]),
x=I(E(P(b,v),P(g,y)),E(P(y,v),P(g,b)));return[...E(Ce(c,h,m,3),r),...l?Ce(l,h,m,2):[f*(1-d),d],...U(x),...s.flat?o.subarray(
2*p,2*p+2):Ce(o,h,m,2),...Array.from(h).slice(0,3),u]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry:e}=this.
header,[t,r]=e.shape,n=[];if(e.triangles){let i=this.parts.get("triangles")?.data??[];for(let o=0;o<i.length;o+=3)n.push(
i[o],i[o+1],i[o+2],i[o+2]);return Uint32Array.from(n)}let s=this.parts.get("cells")?.data;for(let i=0;i<(t-1)*(r-1);i+=1){
if(s&&!s[i])continue;let o=i+Math.floor(i/(r-1));n.push(o,o+1,o+r,o+r+1)}return Uint32Array.from(n)}};var Ue=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],Ps=8,[po,fo]=[24,8],Te=[1,2],go=.2;function Ve(a,e,t){
let r=a.constructor,n=new r(t*e.length);for(let s=0;s<e.length;s+=1)for(let i=0;i<t;i+=1)n[t*s+i]=a[t*e[s]+i];return n}function bo({
geometry:a,bodies:e},t){let[r,n,s]=t.axes,i=(e?.lights??[]).slice(0,Ps),o=i.map(({way:l,turns:h})=>{let m=P(P(k(r,l[0]),
n,l[1]),s,-l[2]);return O(a.frame,h?m:l)}),c=l=>Float32Array.from({length:3*Ps},(h,m)=>l.flat()[m]??0);return{u_lightWays:c(
o),u_lightColours:c(i.map(({color:l})=>l))}}var Lt=class{graphics;header;parts;drawn=null;constructor(e,t,r){this.graphics=
e,this.header=t,this.parts=r}get labels(){return this.header.bodies?.labels??[]}get runs(){let{bodies:e}=this.header;return e&&
Ue.every(t=>this.parts.has(t))?e.runs:[]}get areBehind(){return this.runs.length>0&&this.header.opacity<1}get programs(){
let{programs:e}=this.graphics,{bodyVertex:t,bodyFragment:r,lineVertex:n,lineFragment:s}=this.header.shaders;return[e.get(
t,r),e.get(n,s,"FLOWTEX_BODY"),e.get(t,r,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({
ready:e})=>e)}dispose(){let{drawn:e,graphics:t}=this;if(e){for(let r of e.buffers)t.free("Buffer",r);t.free("VertexArray",
e.faces),t.free("VertexArray",e.pieces),this.drawn=null}}seeThrough(e,t=this.areBehind){if(!this.runs.length)return e();
let r=this.graphics.context;r.enable(r.POLYGON_OFFSET_FILL),r.polygonOffset(Te[0],Te[0]),t&&(r.enable(r.BLEND),r.blendColor(
0,0,0,this.header.opacity),r.blendFuncSeparate(r.CONSTANT_ALPHA,r.ONE_MINUS_CONSTANT_ALPHA,r.ZERO,r.ONE)),e(),r.disable(
r.BLEND),r.disable(r.POLYGON_OFFSET_FILL)}draw({camera:e,anchor:t,width:r,height:n,ratio:s},i){let o=i==="clear",c=this.
runs.filter(({clear:_})=>_===o);if(!c.length)return;let{header:l,graphics:h}=this,{geometry:m}=l,u=h.context,[p,f]=this.
programs,d=this.drawn??=this.make(),g=z(m,e,t),[b,y,v,x]=e.eye,w=O(m.frame,E([b,y,v],k(m.center,x)));o&&(u.enable(u.BLEND),
u.blendFuncSeparate(u.SRC_ALPHA,u.ONE_MINUS_SRC_ALPHA,u.ZERO,u.ONE),u.depthMask(!1)),h.programs.use(p,{u_matrix:g,u_anchor:t,
u_eye:[...E(w,k(t,x)),x],...bo(l,e)}),u.bindVertexArray(d.faces),u.enable(u.POLYGON_OFFSET_FILL),u.polygonOffset(Te[1],Te[1]);
for(let{faces:[_,S],ambient:T,diffuse:L}of c)S&&(h.programs.use(p,{u_ambient:T,u_diffuse:L}),u.drawElements(u.TRIANGLES,
3*S,u.UNSIGNED_INT,12*_));u.disable(u.POLYGON_OFFSET_FILL);let M={u_matrix:g,u_anchor:t,u_picture:[r,n],u_horizon:[0,0,0,
1]};h.programs.use(f,M),u.bindVertexArray(d.pieces);for(let{pieces:[_,S],width:T}of c)if(S){h.programs.use(f,{u_width:T*
s});for(let[L,N,H,K,se]of[[d.ends,3,u.FLOAT,po,0],[d.colours,4,u.UNSIGNED_BYTE,fo,2]]){u.bindBuffer(u.ARRAY_BUFFER,L);for(let C of[
0,1])u.vertexAttribPointer(se+C,N,H,N===4,K,K*(_+C/2))}u.drawArraysInstanced(u.TRIANGLE_STRIP,0,4,S)}u.bindVertexArray(null),
u.depthMask(!0),u.disable(u.BLEND)}hide(e,t){let{runs:r,graphics:n}=this;if(!r.length)return;let s=n.context,i=this.drawn??=
this.make();s.enable(s.POLYGON_OFFSET_FILL),s.polygonOffset(Te[1],Te[1]),n.programs.use(this.programs[2],{u_matrix:e,u_anchor:t}),
s.bindVertexArray(i.faces);for(let{faces:[o,c],clear:l}of r)l||s.drawElements(s.TRIANGLES,3*c,s.UNSIGNED_INT,12*o);s.disable(
s.POLYGON_OFFSET_FILL),s.bindVertexArray(null)}drawLabels(e,{camera:t,anchor:r,width:n,height:s,ratio:i}){let{geometry:o}=this.
header,c=z(o,t,r);for(let{text:l,position:h,size:m,color:u,plate:p}of this.labels){let f=E(O(o.frame,E(h,o.center)),r),[
d,g,,b]=[0,1,2,3].map(S=>c[S]*f[0]+c[4+S]*f[1]+c[8+S]*f[2]+c[12+S]);if(b<=0)continue;let[y,v]=[(.5+.5*d/b)*n,(.5-.5*g/b)*
s],x=m*i,w=go*x;e.font=`600 ${x}px system-ui, sans-serif`,e.textBaseline="middle";let[M,_]=[e.measureText(l).width+2*w,x+
2*w];e.fillStyle=Rs(p),e.beginPath(),e.roundRect(y,v-_,M,_,w),e.fill(),e.fillStyle=Rs(u),e.fillText(l,y+w,v-.5*_)}}make(){
let{graphics:e,parts:t}=this,r=e.context,[n,s,i,o,c]=Ue.map(b=>t.get(b)?.data??[]),l=()=>{let b=e.counted(r.createVertexArray());
return r.bindVertexArray(b),b},h=(b,y=r.ARRAY_BUFFER)=>{let v=e.counted(r.createBuffer());return r.bindBuffer(y,v),r.bufferData(
y,b,r.STATIC_DRAW),v},m=l(),p=[[n,3,r.FLOAT],[s,3,r.BYTE],[i,4,r.UNSIGNED_BYTE]].map(([b,y,v],x)=>{let w=h(b);return r.enableVertexAttribArray(
x),r.vertexAttribPointer(x,y,v,v!==r.FLOAT,0,0),w});p.push(h(o,r.ELEMENT_ARRAY_BUFFER));let f=l(),d=h(Ve(n,c,3)),g=h(Ve(
i,c,4));for(let b=0;b<4;b+=1)r.enableVertexAttribArray(b),r.vertexAttribDivisor(b,1);return r.bindVertexArray(null),{faces:m,
pieces:f,ends:d,colours:g,buffers:[...p,d,g]}}};function Rs([a,e,t,r=1]){return`rgb(${[a,e,t].map(n=>Math.round(255*n)).
join(" ")} / ${r})`}var kt=["land","missing"],yo=.18;function Ls({background:a,earth:e}){let t=a??[1,1,1],r=e?.missingShare??0,n=R(t.map(s=>s**
2.2),[.2126,.7152,.0722])>=yo?0:1;return t.map(s=>s*(1-r)+n*r)}var Is=1e30,ks=65535,Os=256;function vo(a,{low:e,size:t}){let r=[],n=[0,0,0];for(let s=0;s<a.length;s+=4){a[s+3]&&r.push(
[]);let i=n.map((o,c)=>(n[c]=n[c]+a[s+c]&ks,e[c]+n[c]/ks*t[c]));r[r.length-1].push(i)}return r}function xo(a,e){return e?
a.flatMap(t=>{let r=0,n=t.filter((s,i)=>{let o=r;return i&&(r+=Math.hypot(...s.map((l,h)=>l-t[i-1][h]))),Math.floor(r/e)>
Math.floor(o/e)||i===0||i===t.length-1});return r<e?[]:[n]}):a}function wo(a,e){let t=a.reduce((s,i)=>s+i.length+1,0),r=new Float32Array(
3*t).fill(Is),n=0;for(let s of a){n+=3;for(let i of s)for(let o=0;o<3;o+=1)r[n++]=i[o]-e[o]}return r}function Mo(a){let e=[],
t=a.length/3-1;for(let r=0;r<t;r+=Os){let n=Math.min(Os,t-r),[s,i]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let l=3*r;l<3*(r+
n+1);l+=1)a[l]!==Math.fround(Is)&&(s[l%3]=Math.min(s[l%3],a[l]),i[l%3]=Math.max(i[l%3],a[l]));let o=s.map((l,h)=>(l+i[h])/
2),c=Math.hypot(...s.map((l,h)=>(i[h]-l)/2));e.push({first:r,count:n,middle:o,radius:c})}return e}function Eo(a,e){let t=[];
for(let{first:r,count:n,middle:[s,i,o],radius:c}of a){let l=([m,u,p,f])=>m*s+u*i+p*o+f<-c*Math.hypot(m,u,p);if(e.some(l))
continue;let h=t[t.length-1];h&&h[0]+h[1]===r?h[1]+=n:t.push([r,n])}return t}var Fs=12,Ns=2;var Ot=class{version=0;graphics;header;parts;drawn=new Map;constructor(e,t,r){this.graphics=e,this.header=t,this.parts=r}forget(e){
this.version+=1;for(let t of e==="position"?kt:[e])this.drop(t)}dispose(){for(let e of[...this.drawn.keys()])this.drop(e)}drop(e){
let t=this.drawn.get(e);if(t){for(let r of t.buffers)this.graphics.free("Buffer",r);this.graphics.free("VertexArray",t.array),
this.drawn.delete(e)}}get lines(){let{earth:e}=this.header;return e?jr.filter(t=>e[t]&&this.parts.has(t)):[]}drawLines(e,t){
let{header:r,graphics:n}=this,{earth:s,shaders:i}=r,o=n.programs.get(i.lineVertex,i.lineFragment);if(!s||!o.ready)return;
let c=n.context,{camera:l,anchor:h,width:m,height:u,ratio:p}=e;c.bindFramebuffer(c.FRAMEBUFFER,null),c.viewport(0,0,m,u),
c.enable(c.SCISSOR_TEST),c.scissor(0,0,m,u),c.disable(c.DEPTH_TEST),c.enable(c.BLEND),c.blendEquation(c.MAX),c.clearColor(
0,0,0,0);let f=this.horizon(l),g=[...l.planes,...f?[f]:[]].map(w=>this.localPlane(w,h)),b=2*l.height*p/u,y=A(Math.sqrt(u/
p/s.usualHeight),...s.widthRange),v=s.spacingPixels*b,x=s.spacings.find(w=>w<=v)??0;for(let{option:w,color:M,opacity:_,width:S}of s.
strokes){if(!this.lines.includes(w))continue;c.clear(c.COLOR_BUFFER_BIT);let T=this.take(w,h,()=>this.linesOf(w,h,x),x);
n.programs.use(o,{u_matrix:z(r.geometry,l,h),u_picture:[m,u],u_width:S*y*p,u_lineColour:[...M,_],u_horizon:f?g[g.length-
1]:[0,0,0,1]}),c.bindVertexArray(T.array),c.bindBuffer(c.ARRAY_BUFFER,T.buffers[0]);for(let[L,N]of Eo(T.groups,g)){for(let H=0;H<
Ns;H+=1)c.vertexAttribPointer(H,3,c.FLOAT,!1,Fs,(L+H)*Fs);c.drawArraysInstanced(c.TRIANGLE_STRIP,0,4,N)}t()}c.bindVertexArray(
null),c.blendEquation(c.FUNC_ADD),c.disable(c.BLEND)}get isReady(){let{lineVertex:e,lineFragment:t}=this.header.shaders,
{earth:r}=this.header;return r?.land&&(r.map===null&&r.below&&!this.groundProgram("FLOWTEX_GLOBE").ready||this.hasCells&&
!this.groundProgram(...this.roundness).ready)?!1:!this.lines.length||this.graphics.programs.get(e,t).ready}groundProgram(...e){
let{groundVertex:t,groundFragment:r}=this.header.shaders;return this.graphics.programs.get(t,r,...e)}get hasCells(){return kt.
some(e=>this.parts.has(e))}get roundness(){return this.header.earth?.map===null?["FLOWTEX_ROUND"]:[]}drawGround({camera:e,
anchor:t}){let{header:r,graphics:n}=this,{earth:s,geometry:i}=r;if(!s?.land)return;let o=s.map===null,c=kt.filter(p=>this.
parts.has(p)),l=n.context,h={u_matrix:z(i,e,t),u_ground:r.background??[1,1,1],u_lit:r.lighting,u_toEye:O(i.frame,k(e.axes[2],
-1))},m=Ls(r);if(o&&s.below){let p=this.groundProgram("FLOWTEX_GLOBE");if(!p.ready)return;n.programs.use(p,{...h,u_colour:m,
...this.disc(e,s.radius,t)}),l.bindVertexArray(this.take("disc",t,()=>this.emptyArray()).array),l.drawArrays(l.TRIANGLE_STRIP,
0,4)}let u=this.groundProgram(...this.roundness);if(!c.length||!u.ready)return l.bindVertexArray(null);l.depthMask(!1);for(let p of c){
let f=p==="land"?s.land:m,d=E(O(i.frame,k(i.center,-1)),t);n.programs.use(u,{...h,u_colour:f,...o&&{u_middle:d}});let g=this.
take(p,t,()=>this.cellsOf(p,t));l.bindVertexArray(g.array),l.drawElements(l.TRIANGLES,g.count,l.UNSIGNED_INT,0)}l.depthMask(
!0),l.bindVertexArray(null)}horizon(e){let{earth:t}=this.header;if(!t||t.map)return null;let{radius:r}=t,[n,s,i,o]=e.eye,
c=o*Math.hypot(n,s,i);return[...U([n,s,i]),c?-(r**2)/c:0]}localPlane(e,t){let{frame:r,center:n}=this.header.geometry,s=e.
slice(0,3),i=O(r,s);return[...i,R(i,t)+R(s,n)+e[3]]}disc(e,t,r){let{frame:n,center:s}=this.header.geometry,[i,o,c,l]=this.
horizon(e)??[0,0,1,0],h=[i,o,c],m=Math.sqrt(Math.max(t**2-l**2,0)),u=U(I(e.axes[1],h)),p=I(h,u),f=P(k(h,-l),s,-1);return{
u_middle:E(O(n,f),r),u_aside:k(O(n,u),m),u_upward:k(O(n,p),m),u_away:e.state.parallel?0:F(e.state.position)/t}}take(e,t,r,n=0){
let s=this.drawn.get(e);if(s&&String([s.anchor,s.spacing])===String([t,n]))return s;this.drop(e);let i={...r(),anchor:t,
spacing:n};return this.drawn.set(e,i),i}emptyArray(){let{graphics:e}=this;return{array:e.counted(e.context.createVertexArray()),
buffers:[],anchor:[0,0,0],spacing:0,count:0,groups:[]}}buffer(e,t){let{graphics:r}=this,n=r.context,s=r.counted(n.createBuffer());
return n.bindBuffer(e,s),n.bufferData(e,t,n.STATIC_DRAW),s}linesOf(e,t,r){let n=this.graphics.context,{earth:s}=this.header,
i=this.parts.get(e)?.data??[],o=s?vo(i,s):[],c=wo(xo(o,r),t),l={...this.emptyArray(),groups:Mo(c)};n.bindVertexArray(l.array),
l.buffers=[this.buffer(n.ARRAY_BUFFER,c)];for(let h=0;h<Ns;h+=1)n.enableVertexAttribArray(h),n.vertexAttribDivisor(h,1);
return l}cellsOf(e,t){let r=this.graphics.context,n=this.parts.get(e),s=this.parts.get("position"),i=this.emptyArray();if(!n||
!s)return i;let o=this.header.geometry.triangles?n.data:So(n);r.bindVertexArray(i.array);let c=gt(s.data,t);return i.buffers=
[this.buffer(r.ARRAY_BUFFER,c),this.buffer(r.ELEMENT_ARRAY_BUFFER,o)],i.count=o.length,r.enableVertexAttribArray(0),r.vertexAttribPointer(
0,3,r.FLOAT,!1,0,0),i}};function So({data:a,shape:[e,t]}){let r=[];for(let n=0;n<e*t;n+=1){if(!a[n])continue;let s=n+Math.
floor(n/t),i=s+t+1;r.push(s,s+1,i+1,s,i+1,i)}return Uint32Array.from(r)}var[Ao,To]=[.01,.2],[re,Cs]=[4,24],Us=9;function Vs(a,e,t){let r={lines:{"from saddle":[],"to saddle":[],"stable orbit":[],
"unstable orbit":[]},points:[]};for(let s=0;s<Math.min(a.length/re,t.points);s+=1){let i=a[re*s+3];(r.points[i]??=[]).push(
...[0,1,2].map(o=>a[re*s+o]))}let n=NaN;for(let s=0;s<e.length/re;s+=1){let i=e[re*s+3];if(i>=tt.saddle*t.saddles)continue;
let o=i&tt.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],c=r.lines[o[i&tt.leaving?0:1]];i!==n&&c.push(
[]),n=i,c[c.length-1].push(...[0,1,2].map(l=>e[re*s+l]))}return r}function _o(a,e){let t=[];for(let r=0;r<a.length;r+=re)
a[r+3]===e&&t.push(a[r],a[r+1],a[r+2]);return Float32Array.from(t)}function De(a,e=!1){let t=Float32Array.from(a.flat());
if(e)return Ve(t,Array.from({length:2*t.length/3},(s,i)=>i>>1),3);let r=[],n=0;for(let s of a){let i=s.length/3;for(let o=n;o<
n+i-1;o+=1)r.push(o,o+1);n+=i}return Ve(t,r,3)}var Ft=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}kinds(e){let t=this.header.structure?.parts??[];return Object.keys(Me).filter(
r=>t.includes(r)&&Number(e[Me[r]])>0)}lacking(e,t){let r=_r(t);return this.kinds(e).flatMap(n=>this.parts.has(`${n}/${r}`)?
[]:[[n,r]])}get program(){let{lineVertex:e,lineFragment:t}=this.header.shaders;return this.graphics.programs.get(e,t,"FL\
OWTEX_BODY","FLOWTEX_MARK")}isReady(e){return!this.kinds(e).length||this.program.ready}shown(e,t,r){let s=this.kinds(e).
includes(r)?this.parts.get(`${r}/${_r(t)}`):void 0;return[s?Number(e[Me[r]]):0,s]}legend(e,t){let[r,n]=this.shown(e,t,"c\
ritical"),s=new Set;for(let u=0;u<Math.min(r,n?.shape[0]??0);u+=1)s.add(Number(n?.data[re*u+3]));let{kinds:i=[],lines:o={},
nullclines:c=[]}=this.header.structure??{},[l,h]=this.shown(e,t,"separatrices"),m=Object.entries(Vs([],h?.data??[],{points:0,
saddles:l}).lines).filter(([,u])=>u.length).map(([u])=>({name:u,color:o[u]}));return this.shown(e,t,"nullclines")[0]&&m.
push(...c),[...i.filter((u,p)=>s.has(p)),...m.map(u=>({...u,isLine:!0}))]}draw({camera:e,anchor:t,width:r,height:n,ratio:s},i,o){
let{header:c,graphics:l}=this,{structure:h,geometry:m}=c,u=h&&this.layers(h,i,o);if(!h||!u?.length)return;let p=l.context,
[f,d,g,b]=e.eye,y=O(m.frame,E([f,d,g],k(m.center,b))),v=s*A(Math.sqrt(n/s/h.usualHeight),...h.widthRange),x=b?1:e.distance/
Math.hypot(...y);p.bindVertexArray(this.array),p.enable(p.BLEND),p.blendFuncSeparate(p.SRC_ALPHA,p.ONE_MINUS_SRC_ALPHA,p.
ZERO,p.ONE),p.depthFunc(p.LEQUAL);let w=this.program;l.programs.use(w,{u_matrix:z(m,e,t),u_anchor:t,u_eye:[...E(y,k(t,b)),
b],u_picture:[r,n],u_horizon:[0,0,0,1]}),p.bindBuffer(p.ARRAY_BUFFER,this.buffer);for(let{first:M,count:_,color:S,width:T,
above:L}of u){let[N,H,K,se=1]=S;l.programs.use(w,{u_width:T*v,u_nearer:Ao*x*(1+To*L)});for(let C of[0,1])p.vertexAttribPointer(
C,3,p.FLOAT,!1,Cs,Cs*(M+C/2)),p.vertexAttrib4f(2+C,N,H,K,se);p.drawArraysInstanced(p.TRIANGLE_STRIP,0,4,_)}p.bindVertexArray(
null),p.depthFunc(p.LESS),p.disable(p.BLEND)}layers(e,t,r){let[[n,s],[i,o],[,c]]=["critical","separatrices","nullclines"].
map(w=>this.shown(t,r,w)),l=JSON.stringify([n,s?.digest,i,o?.digest,c?.digest,_r(r)]);if(this.drawn?.key===l)return this.
drawn.layers;let h=Vs(s?.data??[],o?.data??[],{points:n,saddles:i}),{line:m,dot:u,rim:p,middle:f}=e,d=[],g=[],b=0,y=(w,M,_,S)=>{
let T=w.length/6;T&&d.push({first:b,count:T,color:M,width:_,above:S}),g.push(w),b+=T},v=e.nullclines.map((w,M)=>_o(c?.data??
[],M));v.forEach(w=>y(w,p,m[0],0)),v.forEach((w,M)=>y(w,e.nullclines[M].color,m[1],1)),y(De(Object.values(h.lines).flat()),
p,m[0],1.5),Object.entries(h.lines).forEach(([w,M],_)=>y(De(M),e.lines[w],m[1],2+_));let x=e.kinds.map((w,M)=>h.points[M]??
[]);return y(De(x,!0),p,u[0],6),e.kinds.forEach(({color:w},M)=>y(De([x[M]],!0),w,u[1],7)),y(De(x.filter((w,M)=>e.kinds[M].
turns),!0),f,u[2],8),this.send(g),this.drawn={key:l,layers:d},d}send(e){let{graphics:t}=this,r=t.context;this.array??=t.
counted(r.createVertexArray()),this.buffer??=t.counted(r.createBuffer()),r.bindVertexArray(this.array),r.bindBuffer(r.ARRAY_BUFFER,
this.buffer),r.bufferData(r.ARRAY_BUFFER,Float32Array.from(e.flatMap(n=>[...n])),r.STATIC_DRAW);for(let n of[0,1])r.enableVertexAttribArray(
n),r.vertexAttribDivisor(n,1);r.bindVertexArray(null)}at({place:e,position:t,height:r},n,s,i){let{geometry:o,structure:c}=this.
header,[l,h]=this.shown(s,i,"critical"),m=2*n.height/Math.max(r,1),[u,p]=["",Us];for(let f=0;f<Math.min(l,h?.shape[0]??0);f+=
1){let[d,g,b,y]=[0,1,2,3].map(M=>Number(h?.data[re*f+M])),v=P(Z(o.frame,[d,g,b]),o.center),x=n.project(v);if(!x||Math.hypot(
...E(v,t))>4*Us*m)continue;let w=.5*r*Math.hypot((x[0]-e[0])*n.aspect,x[1]-e[1]);w<p&&([u,p]=[c?.kinds[y]?.name??"",w])}
return u}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.
buffer=this.drawn=null}};function _r([a,e,t]){return t<.5?a:e}var Po={position:["nodes"],normal:["nodes"],cells:["cells"],triangles:["nodes","cells","scalar"],blocks:["cells"],cmap:[
"cmap"],image:["image"],step:["step"],scalars:["scalar"]},Ds=["padded","unit","open","nearest","rays"],Ro=8*(4/3),Lo=2048,
ko=["u_slices","u_slicesNext","u_image","u_stepImage","u_nodes"],Oo=0,_e=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];version=0;resources=new Map;scalarSteps="";most=null;tracing="";wanted=[];number=Oo+=1;constructor(e,t,r,n=null){
this.tile=n,this.graphics=e,this.header=t,this.parts=r,this.earth=new Ot(e,t,r),this.bodies=new Lt(e,t,r),this.arrows=new Rt(
e,t,r),this.marks=new Ft(e,t,r)}isReady(e,t=!1){let r=[!1,!0].map(o=>this.arrows.program(e,o));return[...["place","surfa\
ce","smooth","probe"].filter(o=>t||o!=="smooth").map(o=>this.programs(o).ready),this.earth.isReady,this.bodies.isReady,this.
marks.isReady(e)].every(Boolean)&&r.every(o=>o?.ready??!0)}missing(e,t){let{geometry:r,slices:n,scalars:s,image:i,pyramid:o,
formula:c}=this.header,{trace:l}=n,h=["mesh",...l?.parts??["position",...r.planar?[]:["normal"]]];o&&!c&&h.push("places"),
this.header.bodies?.runs.length&&h.push(...Ue),r.triangles&&h.push("triangles","blocks");for(let m of new Set([e,t]))l?h.
push(...ie(this.header,m).map(u=>`flow/${u}`)):h.push(`slices/${m}`),n.channels===2&&h.push(`extra/${m}`);return h.push(
...this.scalarParts(e,t)),s.name!==null&&h.push("cmap"),i&&h.push("image","step"),[...new Set(h)].filter(m=>!this.fits(m))}lacking(e){
let t=this.missing(e,e).map(r=>r.startsWith("flow/")?X(r):e);return[...new Set(t)]}scalarParts(e,t,r=this.header.scalars){
let{name:n,steps:s,number:i}=r;if(n===null)return[];let o=i?`/${i}`:"";return(s>1?[e,t]:[0,0]).map(c=>`scalars/${c}${o}`)}fits(e){
let t=this.parts.get(e);if(!t)return!1;let{geometry:r,slices:n,image:s,mesh:i}=this.header,o=r.shape.map(m=>Math.max(Math.
ceil((m-1)/i.tileCells),1)),c=n.trace?.nodes??[],h={flow:[...c,t.shape[2]],unit:c,padded:[...c.map(m=>m+2),3],slices:[n.
count,r.rows.size,r.columns.size,n.channels],position:[...r.shape,3],mesh:r.triangles?t.shape:[...o,t.shape[2]],step:s?[
...s.stepSize].reverse():[]}[e.split("/")[0]];return!h||String(h)===String(t.shape)}make(e,t){let{slices:r,geometry:n}=this.
header,{trace:s}=r;if(!s)return!0;let i=this.part("padded"),o=c=>this.key(["padded"],c,s);return this.put("position",o("\
position"),()=>Rn(i,s,n.shape)),!n.planar&&!s.parts.includes("normal")&&this.put("normal",o("normal"),()=>Ln(i,s,n.shape)),
this.wanted=e,e.every(c=>this.trace(c,t))}prepare(){let{trace:e}=this.header.slices;e&&at(this.graphics,this.header,e)}trace(e,t){
let{graphics:r,header:n}=this,{trace:s,lags:i,sides:o}=n.slices,c=`slices/${e}`;if(!s||this.resources.has(c))return!0;let l=ie(
n,e).map(u=>`flow/${u}`),h=this.key([...l,...Ds],e,s,i,o,n.geometry.levels),m=null;if(!h||!r.common.has(`slices ${h}`)){
let{tracings:u}=r,p=h||`${this.number} ${e}`;this.tracing!==p&&this.stopTracing();let f=g=>this.parts.get(g),d=u.get(p)??
new it(r,n,s,f,e);if(u.set(this.tracing=p,d),m=d.advance(t),!m)return!1;this.stopTracing()}return this.take(c,"Texture",
h,()=>m,()=>{}),!0}put(e,t,r){let{graphics:n,parts:s}=this;if(s.get(e)?.digest===t)return;let i=n.stock.get(t)?.part??{...r(),
digest:t};n.release(s.get(e)),s.set(e,n.hold(i)),this.forget(e)}isMade(e){return!this.missing(e[0],e[e.length-1]).length&&
(!this.header.slices.trace||this.isLoaded(e))}stopTracing(){this.graphics.tracings.get(this.tracing)?.dispose(),this.graphics.
tracings.delete(this.tracing),this.tracing=""}part(e){let t=this.parts.get(e);if(!t)throw new Error(`the part "${e}" of \
the scene is missing`);return t}forget(e){let[t,r]=e.split("/");["position","cells","triangles"].includes(t)&&this.arrows.
forget();let n=["slices","extra","flow"].includes(t);!n&&t!=="scalars"&&(this.earth.forget(e),this.version+=1,this.most=
null),Ue.includes(t)&&this.bodies.dispose();for(let s of n?[`slices/${r}`]:Po[t]??[])this.drop(s);Ds.includes(t)&&(this.
wanted=[],this.dropSlices(NaN,NaN))}drop(e){let t=this.resources.get(e);this.resources.delete(e),t&&(t.users-=1,!t.users&&
(this.graphics.free(t.kind,t.object),this.graphics.common.delete(t.key)))}dispose(){for(let e of[...this.resources.keys()])
this.drop(e);this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),this.marks.dispose()}key(e,...t){
let r=e.map(n=>this.parts.has(n)?this.part(n).digest:"none");return r.every(Boolean)?JSON.stringify([r,t]):""}take(e,t,r,n,s){
let i=this.resources.get(e);if(i)return i.object;let{graphics:o}=this,c=r&&`${e.split("/")[0]} ${r}`,l=c?o.common.get(c):
void 0,h=l?.object??o.counted(n()),m=l??{kind:t,object:h,count:0,key:c,users:0};return m.users+=1,this.resources.set(e,m),
l||(m.count=s(h)||0),c&&o.common.set(c,m),h}get blocks(){return this.part("mesh")}get doublings(){let{geometry:e,mesh:t}=this.
header;return this.most??=ps(e,this.blocks,this.part("position").data,t.tileCells)}cornersAt(e){let{triangles:t,shape:r}=this.
header.geometry;return t?Xn(this.part("triangles").data,e):jn(r,e)}isLoaded(e){return e.every(t=>this.resources.has(`sli\
ces/${t}`))}get tracedBytes(){let{slices:e,geometry:t}=this.header;return e.trace?[...this.resources.keys()].filter(n=>n.
startsWith("slices/")).length*Ro*e.count*t.rows.size*t.columns.size:0}load(e){for(let t of e)this.slices(t)}bindNodes(e){
let t=this.graphics.context,{shape:r,triangles:n,planar:s}=this.header.geometry;e.some((m,u)=>m!==this.anchor[u])&&this.
drop("nodes"),this.anchor=e;let[i,o]=this.nodesSize,c=this.texture("nodes",this.key(["position","normal"],o,e),m=>{cr(t,
o,i),t.bindTexture(t.TEXTURE_2D_ARRAY,m);let u=new Float32Array((s?3:6)*o*i);u.set(gt(this.part("position").data,e)),s||
u.set($n(this.part("normal").data),3*o*i);let p=[o,i,s?1:2];t.texImage3D(t.TEXTURE_2D_ARRAY,0,t.RGB32F,...p,0,t.RGB,t.FLOAT,
u),Bs(t,t.TEXTURE_2D_ARRAY)}),l=()=>this.parts.get("cells")?.data??Uint8Array.of(1),h=n?this.table("cells",this.key(["tr\
iangles","blocks"]),t.RGBA32UI,Lo,()=>Yn(this.part("triangles").data,this.part("blocks").data)):this.table("cells",this.
key(["cells"],r),t.R8UI,this.parts.has("cells")?r[1]-1:1,l);this.bind("u_nodes",c),this.bind(n?"u_corners":"u_open",h)}get nodesSize(){
let{shape:e,triangles:t,rows:r,columns:n}=this.header.geometry;return t?[r.size,n.size]:e}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+de.indexOf(e)),r.bindTexture(ko.includes(e)?r.TEXTURE_2D_ARRAY:r.TEXTURE_2D,t),r.activeTexture(
r.TEXTURE0+de.length)}table(e,t,r,n,s){let i=this.graphics.context,o={[i.RGBA32UI]:[i.RGBA_INTEGER,i.UNSIGNED_INT,4],[i.
R8UI]:[i.RED_INTEGER,i.UNSIGNED_BYTE,1],[i.RG32F]:[i.RG,i.FLOAT,2],[i.RGBA32F]:[i.RGBA,i.FLOAT,4]},[c,l,h]=o[r];return this.
texture(e,t,m=>{let u=s(),p=Math.ceil(u.length/h/n);i.bindTexture(i.TEXTURE_2D,m),i.pixelStorei(i.UNPACK_ALIGNMENT,1);let f=Fo(
u,h*n*p);i.texImage2D(i.TEXTURE_2D,0,r,n,p,0,c,l,f),Bs(i,i.TEXTURE_2D)})}shares(e,t){let{geometry:r,scalars:n}=this.header,
{shape:s}=r,i=this.scalarParts(e,t);return[this.key(["triangles",...new Set(i)],s,n.low,n.high,n.log),()=>bt(i.map(l=>this.
part(l).data),n)]}texture(e,t,r){let n=this.graphics.context;return this.take(e,"Texture",t,()=>n.createTexture(),r)}slices(e){
let{slices:t,geometry:r}=this.header,n=this.key([`slices/${e}`,`extra/${e}`],r.levels,t.extra);return this.texture(`slic\
es/${e}`,n,s=>{let i=this.part(`slices/${e}`),[o,c,l,h]=i.shape,m=i.data,u=this.parts.get(`extra/${e}`)?.data,p=c*l,f=d=>{
let g=m.subarray(d*p*h,(d+1)*p*h);if(h===4)return g;let b=new Uint16Array(4*p),y=t.extra.indexOf(d),v=y<0?null:u?.subarray(
y*p,(y+1)*p);for(let x=0;x<p;x+=1)b[4*x]=g[2*x],b[4*x+1]=g[2*x+1],v&&(b[4*x+3]=v[x]);return b};this.fill(s,{width:l,height:c,
layers:o,channels:4,levels:r.levels},f)})}programs(e){let{programs:t}=this.graphics,{vertex:r,place:n,fullVertex:s,surface:i,
probe:o}=this.header.shaders;return e==="smooth"?t.get(r,i,"FLOWTEX_SMOOTH"):e==="place"?t.get(r,n):t.get(s,e==="probe"?
o:i)}texels(e,t){let{graphics:r,header:n}=this,s=r.context,{slices:i,geometry:o}=n,c=o.columns.size,l=this.slices(e),h=()=>{
s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,l),s.bindVertexArray(null);let p=t.flatMap(f=>[f%c,Math.floor(
f/c)]);r.programs.use(this.programs("probe"),{u_texels:p}),s.drawArrays(s.TRIANGLES,0,3)},m=r.numbers(h,t.length,i.count),
u=new Float32Array(m.buffer);return(p,f)=>{let[d,g,b,y]=u.subarray(4*(p*t.length+f));return[d,g,b,y]}}image(e,t){let r=this.
graphics.context;return this.texture(e,this.key([e],t),n=>{let{data:s,shape:i}=this.part(e),[o,c,l=1]=i,h=Math.floor(Math.
log2(Math.max(c,o))),m={width:c,height:o,layers:1,channels:l,levels:h};this.fill(n,m,()=>s);let u=p=>t[p]?r.REPEAT:r.CLAMP_TO_EDGE;
r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_S,u(1)),r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_T,u(0))})}fill(e,t,r){
let n=this.graphics.context,{width:s,height:i,layers:o,channels:c,levels:l}=t;et(n,e,t),n.pixelStorei(n.UNPACK_ALIGNMENT,
1);let h=c===1?n.RED:n.RGBA;for(let m=0;m<o;m+=1)n.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,m,s,i,1,h,n.HALF_FLOAT,r(m));l&&
n.generateMipmap(n.TEXTURE_2D_ARRAY)}dropSlices(e,t){let r=t+1<this.header.slices.steps?t+1:0,n=[e,t,r,t+1,...this.wanted];
for(let s of[...this.resources.keys()])s.startsWith("slices/")&&!n.includes(X(s))&&this.drop(s)}bindTextures(e,t){let r=this.
graphics.context,{image:n,scalars:s}=this.header,i=String(this.scalarParts(e,t));i!==this.scalarSteps&&this.drop("scalar"),
this.scalarSteps=i,this.dropSlices(e,t),this.bind("u_slices",this.slices(e)),this.bind("u_slicesNext",t===e?null:this.slices(
t)),this.bind("u_image",n&&this.image("image",[!0,!0])),this.bind("u_stepImage",n&&this.image("step",n.repeat));let o=mn(
this.parts.get("cmap")?.data??new Uint8Array(4),s);this.bind("u_cmap",this.table("cmap",this.key(["cmap"],s.beyond),r.RGBA32F,
o.length/4,()=>o));let[c,l]=this.shares(e,t);this.bind("u_shares",s.name===null?null:this.table("scalar",c,r.RG32F,this.
nodesSize[1],l));let h=()=>Wn(n?.alongI??[],n?.alongJ??[]);this.bind("u_along",n&&this.table("along","",r.RG32F,Math.max(
n.alongI.length,n.alongJ.length),h))}};function Bs(a,e){a.texParameteri(e,a.TEXTURE_MIN_FILTER,a.NEAREST),a.texParameteri(
e,a.TEXTURE_MAG_FILTER,a.NEAREST)}function Fo(a,e){if(a.length===e)return a;let t=new a.constructor(e);return t.set(a),t}var No=60,Io=25,Co=9e8,Uo=3.5,Vo={slices:4,flow:24},Nt=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Ae;constructor(e,t){this.host=e,
this.root=t}has(e,t){return this.tiles.get(e)?.parts.has(t)??!1}fail(e,t){this.failed.add(this.need(e,t)),this.host.refine()}need(e,t){
return`${e} ${t} ${this.root.header.scalars.name}`}dispose(){this.isOver=!0;for(let e of[...this.tiles.keys()])this.drop(
e)}setPart(e,t){let{graphics:r,header:n}=this.root,s=this.tiles.get(e)??this.emptyTile();if(this.tiles.set(e,s),t.digest&&
s.parts.get(t.name)?.digest===t.digest)return;if(r.release(s.parts.get(t.name)),s.parts.set(t.name,r.hold(t)),t.name==="\
header"){let l=JSON.parse(new TextDecoder().decode(t.data));s.scene?.dispose(),l&&(l.geometry.reach=n.geometry.reach),s.
scene=l&&new _e(r,{...n,...l,pyramid:null,bodies:null,structure:null},s.parts,oe(e)),this.giveMap(s)}else s.scene?.forget(
t.name);let{names:i,steps:o}=this.chosen;this.missing=this.missing.filter(l=>!this.isHere(l,o));let c=xr(this.chosen.choices,
l=>this.isHere(l,o));String([...c.keys()])!==i&&this.host.refine()}recolour(e={}){let{steps:t}=this.chosen;for(let r of this.
tiles.values()){let{scene:n,parts:s}=r;if(!n||(Object.assign(n.header,e),this.giveMap(r),n.forget("scalars"),(t.length?n.
scalarParts(t[0],t[t.length-1]):[]).every(c=>s.has(c))))continue;let o=[...s.keys()].filter(c=>c.startsWith("scalars/"));
for(let c of o)this.release(r,c)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.count}}giveMap({scene:e,parts:t}){
let r=this.root.parts.get("cmap");r&&t.set("cmap",r),e?.forget("cmap")}arrange([e,t]){let{camera:r}=this.host;if(!r)return[];
let n=this.choose(r,[...new Set([e,t])]);return this.layers=[V,...[...n.keys()].filter(s=>s!==V)].flatMap(s=>{let i=s===
V?this.root:this.tiles.get(s)?.scene,o=(n.get(s)??[]).flatMap(l=>this.pyramid?[this.pyramid.finerPart(oe(l),s)]:[]),c=s===
V?[this.root.header.pyramid?.depth??0,0,0]:oe(s);return i?[{scene:i,key:c,covered:o}]:[]}),this.layers}choose(e,t){let{header:r}=this.
root,{settings:n,canvas:s,ratio:i}=this.host;if(!r.pyramid)return new Map;this.pyramid??=new pt(r.pyramid,Nn(r)??this.root.
part("places").data);let o=this.pyramid.choose({...e.sight(s.height/i),planes:e.planes,cellPixels:Cn(r.pyramid,n),shownOn:this.
host.shownOn});this.count+=1;for(let m of o.keys()){let u=this.tiles.get(m);u&&(u.used=this.count)}let c=performance.now()+
Io,l=this.obtainable(Un(o),t,r.pyramid.depth);this.missing=l.filter(m=>!this.isHere(m,t)),this.ask(),this.trim(t);for(let m of l)
this.isHere(m,t)&&this.load(m,t,c);let h=xr(o,m=>this.isHere(m,t)&&this.load(m,t,c));return this.wanted=l.length,this.pending=
l.filter(m=>!this.isHere(m,t)||!this.isLoaded(m,t)).length,this.chosen={choices:o,steps:t,names:String([...h.keys()])},h}obtainable(e,t,r){
let n=[t,...t.map(o=>[o])],s=o=>n.some(c=>this.failed.has(this.need(o,c))),i=e.map(o=>{let[c,l,h]=oe(o);for(;c<r&&s(G([c,
l,h]));)[c,l,h]=[c+1,l>>1,h>>1];return c<r?G([c,l,h]):V});return[...new Set(i)].filter(o=>o!==V)}isHere(e,t){let r=this.
tiles.get(e)?.scene;return r===null||r?.missing(t[0],t[t.length-1]).length===0}isLoaded(e,t){let r=this.tiles.get(e)?.scene;
return r===null||(r?.isLoaded(t)??!1)}load(e,t,r){let n=this.tiles.get(e)?.scene;return!n||this.isLoaded(e,t)?!0:performance.
now()>r||!n.make(t,r)?(this.host.refine(),!1):(n.load(t),!0)}ask(){let{requests:e,lifetime:t}=this.host;this.isWaiting||
!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,t.later(()=>{if(this.isWaiting=!1,this.isOver)return;this.hasAsked=
this.missing.length>0;let r=(i,o)=>this.tiles.get(i)?.scene?.lacking(o)??ie(this.root.header,o),n=this.missing.flatMap(i=>this.
chosen.steps.flatMap(o=>r(i,o))),s=[...new Set(n)].sort((i,o)=>i-o);e.wantTiles(this.missing.map(oe),s)},No))}trim(e){let t=0;
for(let[r,n]of[...this.tiles].sort(([,s],[,i])=>i.used-s.used)){let{parts:s,scene:i,used:o}=n,c=i?.header.slices.trace?"\
flow":"slices",l=[...s.keys()].filter(m=>m.startsWith(`${c}/`)),h=i?e.flatMap(m=>ie(i.header,m)):e;for(let m of l.slice(
0,Math.max(l.length-Vo[c],0))){let u=X(m);if(h.includes(u))continue;for(let f of[c,"extra"])this.release(n,`${f}/${u}`);
let p=[...s.keys()].filter(f=>Ee(f,u,this.root.header));for(let f of p)this.release(n,f)}for(let{data:m}of s.values())t+=
Uo*m.byteLength;t+=i?.tracedBytes??0,t>(this.host.options.source?.memory??Co)&&o<this.count&&this.drop(r)}}drop(e){let t=this.
tiles.get(e);t?.scene?.dispose();for(let r of[...t?.parts.keys()??[]])this.release(t,r);this.tiles.delete(e)}release(e,t){
t!=="cmap"&&this.root.graphics.release(e?.parts.get(t)),e?.parts.delete(t)}};var It=class{scene=null;tiles=null;places=null;shown=null;view;renderer;next=[];isLate=!1;constructor(e){this.view=e,this.
renderer=new Mt(e,this),!e.graphics.gl&&e.panel.fail("This browser has no WebGL2 with floating-point targets, which are \
needed to draw the picture.","Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.")}open(e){
let{view:t}=this;this.leave(),this.scene=new _e(t.graphics,e,t.parts),this.tiles=new Nt(t,this.scene),this.places=new wt(
t.graphics)}leave(){this.tiles?.dispose(),this.scene?.dispose(),this.places?.dispose(),this.tiles=this.scene=this.places=
null}dispose(){this.leave(),this.renderer.dispose()}restart(e){this.renderer.restart(e)}resize(e,t){this.renderer.resize(
e,t)}refine(){this.renderer.refine()}arrange(e){let t=this.tiles?.arrange(e)??[];return this.view.root.dataset.tiles=String(
this.tiles?.pending??0),t}get smooth(){let{header:e,options:t}=this.view;return t.smooth!==void 0||!e?t.smooth??!1:this.
program(e).price<yn}get isComing(){return!!this.tiles?.missing.length}get lacking(){let[e,t]=this.view.player.moment;return this.
scene?.missing(e,t)??[]}missing(e){return[...new Set(e.flatMap(t=>this.scene?.lacking(t)??[]))]}make(e,t){return this.next=
e,!this.missing(e).length&&!!this.scene?.make(e,t)}available(e){let{view:t,scene:r,shown:n,lacking:s}=this,{header:i,player:o}=t;
if(!i||!r)return null;let c=o.moment,l=o.playing?[1,2].map(p=>(c[1]+p)%i.slices.steps):[],h=this.missing([c[0],c[1],...this.
next,...l]);h.length&&t.requests.hasSteps&&!t.options.isComing?.()&&t.requests.wantSteps(h);let m=!s.length&&r.make(c.slice(
0,2),e);this.isLate=!m;let u=t.requests.hasMarks?r.marks.lacking(t.settings,c):[];return t.options.isComing?.()||t.requests.
wantMarks(u),t.root.dataset.lacking=String(s.length+u.length||+!m),t.panel.wait(s,m,this.renderer.leavesOut,u.length>0),
t.panel.showKinds(r.marks.legend(t.settings,c)),m&&String(c.slice(0,2))!==String(n?.slice(0,2))&&(t.trim(),t.change()),m?
this.shown=c:(s.length||t.request(),n&&r.isMade(n.slice(0,2))?n:null)}program(e,t=this.isClose(e),r=!this.view.player.playing){
let{fullVertex:n,fragment:s}=e.shaders,i=Fn(e,this.view.settings,t,r);return this.view.graphics.programs.get(n,s,...i)}isClose(e){
let{view:t}=this;if(!t.camera)return!1;let r=t.view([0,0,0],t.ratio),n=this.tiles?.layers.slice(1).map(({scene:s})=>s.header)??
[];return(n.length?n:[e]).some(s=>ht(s,t.settings,r))}frame(e,t){let{view:r,scene:n}=this,{graphics:s,header:i}=r;if(s.isLost||
!s.gl||!r.isVisible||!i||!n||r.canvas.width<2)return;this.next=[],r.advance(e);let o=this.available(t);r.camera||r.place();
let c=this.program(i);if(n.prepare(),!o||!r.camera||this.isLate&&r.sharp)return;if(c.error)return r.panel.fail("The shad\
er does not compile with this graphics driver.",c.error);if(!c.ready||!n.isReady(r.settings,this.smooth))return r.request();
let l=!r.sharp&&this.renderer.draw(c,o,t);l&&(i.slices.critical&&this.program(i,!0),r.player.varies&&this.program(i,this.
isClose(i),!1)),r.painted(l)}get canPick(){return!!this.places?.width&&!this.view.graphics.isLost}find(e,t){let{tiles:r,
shown:n,scene:s,view:i}=this,{camera:o}=i,c=r?.layers.length&&n?this.renderer.placeAt(n,e,t):null;if(!c||!o||!n||!s)return null;
let l=ms(c,s,o,n,[e,t]),h={place:[e,t],position:l.point.position,height:i.root.clientHeight};return l.point.mark=s.marks.
at(h,o,i.settings,n),l}};var Pr=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=Tn();lifetime=new ct;held=new ot(
this.graphics);parts=this.held.all;camera=null;sharp=!1;isVisible=!0;isClear=!1;shownOn=null;dispose(){this.lifetime.isOver||
(this.lifetime.end(),this.requests.stop(),this.painter.dispose?.(),this.held.clear(),this.graphics.leave(this))}get scene(){
return this.painter.scene??null}get tiles(){return this.painter.tiles??null}setPart(e){let t=ue(e.name);return t&&this.tiles?.
setPart(t[0],{...e,name:t[1]}),t||!this.held.set(e)?!1:(this.scene?.forget(e.name),this.trim(),e.name==="cmap"&&this.tiles?.
recolour(),this.change(),!0)}lack(e,t,r=[]){t!==void 0&&this.tiles?.fail(t,r),this.tell(e)}trim(){this.held.trim(this.header,
this.options.source,this.player.moment.slice(0,2))}request(){!this.lifetime.isOver&&this.isVisible&&this.graphics.request(
this)}frame(e,t){if(!this.lifetime.isOver)try{this.painter.frame(e,t)}catch(r){this.fail(r)}}lost(){this.header&&this.painter.
open?.(this.header),this.sharp=!1}view(e,t){let{header:r,camera:n,player:s,rows:i}=this;if(!r||!n)throw new Error("no sc\
ene is shown yet");return Hn({header:r,camera:n,anchor:this.scene?.anchor??[0,0,0],player:s,rows:i},e,t)}find(e,t){return this.
painter.canPick?this.painter.find?.(e,t)??null:null}},Ct=class extends Pr{player;isClear=!0;panel;requests;options;header;settings;painter;ratio=1;host;isNew=!0;constructor(e,{
header:t,settings:r,player:n,source:s,isComing:i}){super(),this.host=e,this.header=t,this.settings=r,this.player=n,this.
options={source:s,isComing:i},this.panel={wait:()=>{},showKinds:()=>{},fail:(o,c)=>e.failed(o,c)},this.requests=new dt(s,
this),this.graphics.users.add(this),n.setHeader(t),this.painter=new It(this),this.requests.setHeader(t),this.painter.open(
t)}get isHeld(){return this.host.isHeld()}chooseColours(e){let{colours:t,part:r}=un(this.header,e,this.parts);r&&this.setPart(
r),Object.assign(this.header,t),this.painter.scene?.forget("scalars"),this.tiles?.recolour(t),this.change()}look(e,t,r,n){
let{header:s,canvas:i}=this;this.ratio=n,this.camera=new fe(e,s.limits,s.geometry.planar,t/r);let o=[t,r].map(c=>Math.max(
Math.round(c*n),1));(o[0]!==i.width||o[1]!==i.height)&&this.painter.resize(o[0],o[1]),this.change(!0)}tell(e){this.host.
failed(e,"")}fail(e){this.player.playing=!1,this.host.failed("The flow cannot be drawn.",String(e))}place(){}advance(e){
let{player:t,painter:r}=this;!t.playing||!t.advance(e,n=>r.make(n,e))||(this.host.advanced(),this.change())}change(e=!1){
this.painter.restart(e),this.isNew=!0,this.refine()}refine(){this.isNew||this.painter.refine(),this.sharp=!1,this.request()}painted(e){
this.sharp=e&&!this.player.playing,(this.isNew||e)&&this.host.painted(e),this.isNew=!1,this.sharp||this.request()}get rows(){
return this.canvas.height/this.ratio}};var Hs=`// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;

uniform sampler2D u_flowPicture;
uniform float u_opacity;

out vec4 flowtexOut;

void main()
{
  vec2 place = 0.5 + 0.5 * flowtexPlaceOut.xy / flowtexPlaceOut.z;
  if (flowtexPlaceOut.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  flowtexOut = u_opacity * texture(u_flowPicture, place);
}
`;var zs=`// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow\
.
// \`projectTile\` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  gl_Position = projectTile(place);
}
`;var Gs=1e-5,Pe=Math.atan(Math.sinh(Math.PI))*180/Math.PI,D=Math.PI/180,Ho=88*D,Ws='export it with projection="mercator"';
function ge({lng:a,lat:e}){let t=Math.sin(A(e,-Pe,Pe)*D);return[a/360+.5,.5-Math.atanh(t)/(2*Math.PI)]}var Ut=class{origin;slope;box;constructor(e,t){
let r=e?.map;if(!r||!t)throw new Error(`the flow is not on a map; ${Ws}`);this.box=r;let[n,s]=t.shape,i=(d,g)=>{let[b,y,
v]=t.data.subarray(3*(d*s+g)),x=ge({lng:Math.atan2(y,b)/D,lat:Math.asin(v/Math.hypot(b,y,v))/D}),w=[r[0]+(r[2]-r[0])*g/(s-
1),r[1]+(r[3]-r[1])*d/(n-1)];return{place:x,position:w}},[o,c,l]=[i(1,1),i(n>>1,s>>1),i(n-2,s-2)],h=d=>d+Math.ceil(o.place[0]-
d),m=[h(l.place[0])-o.place[0],l.place[1]-o.place[1]];this.slope=[0,1].map(d=>m[d]/(l.position[d]-o.position[d])),this.origin=
[0,1].map(d=>o.place[d]-this.slope[d]*o.position[d]);let[u,p]=this.placeOf(c.position);if(!(Math.abs(u-h(c.place[0]))<Gs&&
Math.abs(p-c.place[1])<Gs))throw new Error(`the flow is on another map; ${Ws}`)}placeOf(e){return[0,1].map(t=>this.origin[t]+
this.slope[t]*e[t])}lngLatOf(e){let[t,r]=this.placeOf(e);return[360*(t-.5),Math.atan(Math.sinh(2*Math.PI*(.5-r)))/D]}positionOf(e){
let[t,r]=e.map((s,i)=>(s-this.origin[i])/this.slope[i]),n=1/this.slope[0];return[t+n*Math.round((.5*(this.box[0]+this.box[2])-
t)/n),r]}look(e,t){let r=1/(512*2**e.zoom*this.slope[0]),[n,s]=this.positionOf(ge(e.center)),i=f=>e.globe?this.globeLook(
e,r,[f,s,t]):this.flatLook(e,r,[f,s,t]),o=[i(n)],[c,l]=e.globe?[.5*r*o[0].width,.5*r*o[0].width]:[.5*r*Math.min(e.width,
e.height),r*js(e)],[h,,m]=this.box,u=n+(n<.5*(h+m)?1:-1)/this.slope[0];return!(n-c<=h&&n+c>=m)&&Math.abs(u-A(u,h,m))<l&&
o.push(i(u)),o}flatLook({width:e,height:t,bearing:r,pitch:n,fov:s},i,[o,c,l]){let[h,m]=[r*D,n*D],u=.5*t*i,p=u/Math.tan(.5*
s*D);return{state:{position:[o-p*Math.sin(m)*Math.sin(h),c-p*Math.sin(m)*Math.cos(h),l+p*Math.cos(m)],focal_point:[o,c,l],
up:[Math.sin(h),Math.cos(h),0],parallel:n===0,parallel_scale:u,view_angle:s},width:e,height:t}}globeLook(e,t,[r,,n]){let s=1/
(t*this.slope[0]),i=A(e.center.lat,-Pe,Pe)*D,o=s/(2*Math.PI*Math.cos(i)),c=Math.asin(Math.min(js(e)/o,1)),[l,h]=[i-c,i+c].
map(b=>ge({lng:0,lat:b/D})[1]),m=Math.abs(i)+c<=Math.PI/2?Math.asin(Math.sin(c)/Math.cos(i)):Math.PI,u=(.5*(l+h)-this.origin[1])/
this.slope[1],[p,f]=[m/Math.PI,l-h],d={position:[r,u,n+1/this.slope[0]],focal_point:[r,u,n],up:[0,1,0],parallel:!0,parallel_scale:.5*
f/this.slope[0],view_angle:e.fov},g=new Rr(this,e.center,c);return{state:d,width:p*s,height:f*s,shownOn:g}}},Rr=class{mercator;middle;cosine;seen;constructor(e,{
lng:t,lat:r},n){let s=A(r,-Pe,Pe);this.mercator=e,this.middle=$s(t,s),this.cosine=Math.cos(s*D),this.seen=n}sees(e){let[
t,r,,n]=Array.from(e);return Math.acos(A(R($s(...this.mercator.lngLatOf([t,r])),this.middle),-1,1))<=this.seen+this.angle(
n)}scale(e){let[,t,,r]=Array.from(e),n=Math.abs(2*Math.PI*(this.mercator.placeOf([0,t])[1]-.5)),s=Math.max(n-this.angle(
r),0);return Math.min(1/Math.cosh(s)/this.cosine,1)}angle(e){return 2*Math.PI*this.mercator.slope[0]*e}};function $s(a,e){
let t=Math.cos(e*D);return[t*Math.cos(a*D),t*Math.sin(a*D),Math.sin(e*D)]}function js({width:a,height:e,pitch:t,fov:r}){
let[n,s]=[t*D,.5*r*D],i=n+s;if(i>Ho)return 1/0;let c=.5*e/Math.tan(s)*Math.cos(n)*(Math.tan(i)-Math.tan(n));return Math.
hypot(c,.5*a*Math.cos(n)*Math.cos(s)/Math.cos(i))}var Lr=8192,zo=22,Go=64,Vt=class{view;isUsed=!1;texture;shown=null;next=null;constructor(e,t){this.view=t,this.texture=e.
createTexture()}dispose(e){this.view.dispose(),e?.deleteTexture(this.texture)}follow(e,t){this.isUsed=this.view.isVisible=
e!==void 0,this.view.shownOn=e?.shownOn??null,e?this.view.look(e.state,e.width,e.height,t):this.shown=this.next=null}painted(e){
let{camera:t}=this.view;t&&this.isUsed&&(this.next={camera:t,isComplete:e})}get isComplete(){let{view:e,next:t,shown:r}=this;
return!this.isUsed||e.sharp&&!t&&!!r?.isComplete&&!e.tiles?.pending}upload(e,t){if(this.next){e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,
!0),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.UNSIGNED_BYTE,this.view.
canvas);for(let r of[e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D,r,e.CLAMP_TO_EDGE);t&&e.generateMipmap(
e.TEXTURE_2D),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,t?e.LINEAR_MIPMAP_LINEAR:e.LINEAR),e.texParameteri(e.TEXTURE_2D,
e.TEXTURE_MAG_FILTER,e.LINEAR),this.shown=this.next,this.next=null}}draw(e){let{gl:t,programs:r,mercator:n,globe:s}=e,{vertexShaderPrelude:i,
define:o}=e.shaderData,c=r.get(`${o}
${i}
${zs}`,Hs);if(!c.ready)return c.error;if(t.activeTexture(t.TEXTURE0),t.bindTexture(t.TEXTURE_2D,this.texture),this.upload(
t,s),!this.shown)return!0;let{camera:l}=this.shown,h=Math.floor(A(e.zoom,0,zo)),m=n.placeOf(l.state.focal_point),u=2**h,
p=[Math.floor(m[0]*u),A(Math.floor(m[1]*u),0,u-1)],f=Math.floor(p[0]/u),d={z:h,x:p[0]-f*u,y:p[1]},g=T=>T.map((L,N)=>(L*u-
p[N])*Lr),[b,y,v,x]=n.box,[w,M]=[[b,y],[v,x]].map(T=>g(n.placeOf(T)));t.bindVertexArray(e.array);let _=s?Go:1,S=s?0:Math.
round(ge(e.center)[0]-m[0]);for(let T of e.isRepeated&&!s?[-1,0,1]:[0]){let L={wrap:f+S+T,canonical:d},N=e.getProjectionData(
{tileID:L,applyGlobeMatrix:s});r.use(c,{u_projection_matrix:N.mainMatrix,u_projection_fallback_matrix:N.fallbackMatrix,u_projection_tile_mercator_coords:N.
tileMercatorCoords,u_projection_clipping_plane:N.clippingPlane,u_projection_transition:N.projectionTransition,u_box:[...w,
M[0]-w[0],M[1]-w[1]],u_mapCells:_,u_flowMatrix:Wo(this.view.header,l,n,p,1/(u*Lr)),u_flowPicture:0,u_opacity:e.opacity}),
t.drawArraysInstanced(t.TRIANGLE_STRIP,0,2*_+2,_)}return t.bindVertexArray(null),!0}};function Wo({geometry:a},e,t,r,n){
let{center:s,frame:i}=a,{focal_point:o}=e.state,c=O(i,E(o,s)),l=z(a,e,c),h=[0,1].map(f=>O(i,[0,1].map(d=>d===f?n/t.slope[f]:
0).concat(0))),m=t.placeOf(o),u=[0,1].map(f=>(r[f]*n*Lr-m[f])/t.slope[f]).concat(0);return[...h,[0,0,0],O(i,u)].flatMap(
(f,d)=>[0,1,2,3].map(g=>f.reduce((b,y,v)=>b+l[4*v+g]*y,d===3?l[12+g]:0)))}var Dt=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(e,t,r,n){this.header=e,this.known=r,this.texts=
n;for(let s of t){let[{name:i,digest:o},c]=s,l=ue(i)?.[0];l?this.tiles.set(l,[...this.tiles.get(l)??[],s]):this.parts.push(
s),l&&c&&n.set(o,c)}}load=(e,t)=>{let r=((e&&this.tiles.get(G(e)))??[]).filter(([{name:n}])=>{let s=ue(n)?.[1]??"",i=X(s),
o=s.startsWith("scalars/")&&!Ee(s,i,this.header);return Number.isNaN(i)||t.includes(i)||o});return Promise.all(r.map(n=>this.
unpacked(n)))};async unpacked([e,t]){let{digest:r,name:n}=e,s=this.known.get(r);return s?{...s,name:n}:qr(e,t||(this.texts.
get(r)??""))}async kept(e){let t=await this.unpacked(e);return this.known.set(t.digest,t),t}};var Be=class{};var be=class extends Error{},q=class extends be{_tag="NotFoundError";name="NotFoundError";path;found;constructor(e,t={}){
super(`Not found: ${e}`,{cause:t.cause}),this.path=t.path,this.found=t.found}},B=class extends be{_tag="InvalidMetadataE\
rror";name="InvalidMetadataError";path;constructor(e,t={}){super(e,{cause:t.cause}),this.path=t.path}},He=class extends be{_tag="\
UnknownCodecError";name="UnknownCodecError";codec;constructor(e){super(`Unknown codec: ${e}`),this.codec=e}},ze=class extends be{_tag="\
CodecPipelineError";name="CodecPipelineError";direction;codec;chunkPath;constructor(e){let t=[`Failed to ${e.direction} \
chunk`,e.codec&&`via codec "${e.codec}"`,e.chunkPath&&`at ${e.chunkPath}`].filter(Boolean);super(t.join(" "),{cause:e.cause}),
this.direction=e.direction,this.codec=e.codec,this.chunkPath=e.chunkPath}};var ye=class extends be{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(e){super(`Unsupported: ${e}`),
this.feature=e}};var Ge=class{},We=class{},$e=class{};function Xs(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not available. In browsers, this req\
uires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function qs(a,e){return e?new SharedArrayBuffer(
a):new ArrayBuffer(a)}function je(a){let e=new TextDecoder().decode(a);try{return JSON.parse(e)}catch(t){throw new B("Fa\
iled to decode JSON",{cause:t})}}function kr(a,e){let t=e/2,r=e-1,n=0;for(let s=0;s<a.length;s+=e)for(let i=0;i<t;i+=1)n=
a[s+i],a[s+i]=a[s+r-i],a[s+r-i]=n}function Ht(a){if(a==="v2:object")return globalThis.Array;let e=a.match(/v2:([US])(\d+)/);
if(e){let[,r,n]=e;return(r==="U"?$e:We).bind(null,Number(n))}if(a==="string")return globalThis.Array;let t={int8:Int8Array,
int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:Ge}[a];if(!t)
throw new B(`Unknown or unsupported dataType: ${a}`);return t}function zt(a,e){let t=a.length;typeof e=="string"&&(e=e===
"C"?Array.from({length:t},(s,i)=>i):Array.from({length:t},(s,i)=>t-1-i)),ea(t===e.length,"Order length must match the nu\
mber of dimensions.");let r=1,n=new Array(t);for(let s=e.length-1;s>=0;s--)n[e[s]]=r,r*=a[e[s]];return n}function Ks({name:a,
configuration:e}){if(a==="default"){let t=e?.separator??"/";return r=>["c",...r].join(t)}if(a==="v2"){let t=e?.separator??
".";return r=>r.join(t)||"0"}throw new B(`Unknown chunk key encoding: ${a}`)}function Ys(a){if(a==="|O")return{dataType:"\
v2:object"};let e=a.match(/^([<|>])(.*)$/);if(!e)throw new B(`Invalid dtype: ${a}`);let[,t,r]=e,n={b1:"bool",i1:"int8",u1:"\
uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[r]??
(r.startsWith("S")||r.startsWith("U")?`v2:${r}`:void 0);if(!n)throw new B(`Unsupported or unknown dtype: ${a}`);return t===
"|"?{dataType:n}:{dataType:n,endian:t==="<"?"little":"big"}}function $o(a){return(a.id==="fixedscaleoffset"||a.id==="num\
codecs.fixedscaleoffset")&&typeof a.scale=="number"&&typeof a.offset=="number"&&(a.astype===void 0||typeof a.astype=="st\
ring")&&(a.dtype===void 0||typeof a.dtype=="string")}function Js(a,e={}){let t=[],r=Ys(a.dtype);a.order==="F"&&t.push({name:"\
transpose",configuration:{order:"F"}});for(let s of a.filters??[]){if(s.id==="fixedscaleoffset"||s.id==="numcodecs.fixed\
scaleoffset"){if(!$o(s))throw new B(`Invalid fixedscaleoffset filter: ${JSON.stringify(s)}`);t.push({name:"scale_offset",
configuration:{scale:s.scale,offset:s.offset}});let c=s.astype??s.dtype;if(c!==void 0&&c!==a.dtype){let l=Ys(c).dataType;
if(!Bt(l,"number")&&!Bt(l,"bigint"))throw new B(`fixedscaleoffset astype must be a numeric data type, got ${c}`);t.push(
{name:"cast_value",configuration:{data_type:l,rounding:"nearest-even",out_of_range:"wrap"}})}continue}let{id:i,...o}=s;t.
push({name:`numcodecs.${i}`,configuration:o})}if("endian"in r&&r.endian==="big"&&t.push({name:"bytes",configuration:{endian:"\
big"}}),a.compressor){let{id:s,...i}=a.compressor;t.push({name:`numcodecs.${s}`,configuration:i})}let n;return globalThis.
Array.isArray(e._ARRAY_DIMENSIONS)&&(n=e._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:a.shape,data_type:r.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:a.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:a.
dimension_separator??"."}},codecs:t,fill_value:a.fill_value,dimension_names:n,attributes:e}}function Zs(a,e={}){return{zarr_format:3,
node_type:"group",attributes:e}}function Bt(a,e){if(e!=="number"&&e!=="bigint"&&e!=="boolean"&&e!=="object"&&e!=="string")
return a===e;let t=a==="bool";if(e==="boolean")return t;let r=a.startsWith("v2:U")||a.startsWith("v2:S")||a==="string";if(e===
"string")return r;let n=a==="int64"||a==="uint64";if(e==="bigint")return n;let s=a==="v2:object";return e==="object"?s:!r&&
!n&&!t&&!s}function Qs(a){return a?.name==="sharding_indexed"}function Gt(a){if((a.data_type==="uint64"||a.data_type==="\
int64")&&a.fill_value!=null)return BigInt(a.fill_value);let e=a.data_type==="float16"||a.data_type==="float32"||a.data_type===
"float64";if(typeof a.fill_value=="string"&&e){let t={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(a.fill_value in t)return t[a.
fill_value]}return a.fill_value}function Or(a,...e){if(!e.some(t=>a instanceof t))throw a}function ea(a,e=""){if(!a)throw new Error(e)}async function ta(a,{
format:e,signal:t}){let r;if(a instanceof ArrayBuffer)r=new Response(a);else{let n=new Uint8Array(a.buffer,a.byteOffset,
a.byteLength);r=new Response(n.slice().buffer)}ea(r.body,"Response does not contain body.");try{return await new Response(
r.body.pipeThrough(new DecompressionStream(e),{signal:t})).arrayBuffer()}catch{throw t?.throwIfAborted(),new Error(`Fail\
ed to decode ${e}`)}}var ra=jo();function jo(){let a=new Uint32Array([305419896]);return new Uint8Array(a.buffer,a.byteOffset,a.byteLength)[0]!==
18}function na(a){return"BYTES_PER_ELEMENT"in a?a.BYTES_PER_ELEMENT:4}var Ye=class a{kind="array_to_bytes";#e;#t;#r;#s;#n;constructor(e,t){
this.#n=e?.endian,this.#t=Ht(t.dataType),this.#s=t.shape,this.#e=zt(t.shape,"C");let r=new this.#t(0);this.#r=r.BYTES_PER_ELEMENT}static fromConfig(e,t){
return new a(e,t)}encode(e){let t=new Uint8Array(e.data.buffer);return ra&&this.#n==="big"&&(t=t.slice(),kr(t,na(this.#t))),
t}computeEncodedSize(e){return e}decode(e){return ra&&this.#n==="big"&&(e=e.slice(),kr(e,na(this.#t))),e.byteOffset%this.#r!==
0&&(e=e.slice()),{data:new this.#t(e.buffer,e.byteOffset,e.byteLength/this.#r),shape:this.#s,stride:this.#e}}};var Wt=class{};function $t(a){return()=>{throw new ye(`${a} encode`)}}var jt=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode=$t("crc32c");decode(e){return new Uint8Array(
e.buffer,e.byteOffset,e.byteLength-4)}computeEncodedSize(e){return e+4}};var Yt=class{};var Xt=class a{kind="bytes_to_bytes";static fromConfig(e){return new a}encode=$t("gzip");async decode(e){let t=await ta(
e,{format:"gzip"});return new Uint8Array(t)}};var Xe=class{};var qt=class{};var Kt=class{};var Jt=class{};var qe=class{};var Zt=class{};function Yo(){let a=()=>import("numcodecs/blosc").then(s=>s.default),e=()=>import("numcodecs/lz4").then(s=>s.default),t=()=>import("numcodecs/zstd").
then(s=>s.default),r=()=>Xt,n=()=>Zt;return new Map().set("blosc",a).set("lz4",e).set("zstd",t).set("gzip",r).set("zlib",
n).set("transpose",()=>Jt).set("bytes",()=>Ye).set("crc32c",()=>jt).set("vlen-utf8",()=>qe).set("json2",()=>Xe).set("bit\
round",()=>Be).set("cast_value",()=>Wt).set("scale_offset",()=>qt).set("numcodecs.blosc",a).set("numcodecs.lz4",e).set("\
numcodecs.zstd",t).set("numcodecs.gzip",r).set("numcodecs.zlib",n).set("numcodecs.vlen-utf8",()=>qe).set("numcodecs.shuf\
fle",()=>Kt).set("numcodecs.delta",()=>Yt).set("numcodecs.bitround",()=>Be).set("numcodecs.json2",()=>Xe)}var Ke=Yo();function Je(a){
let e;function t(){return e||(e=Xo(a)),e}async function r(n,s,i){try{return await i()}catch(o){throw new ze({direction:n,
codec:s,cause:o})}}return{async encode(n){let s=await t();for(let{name:o,codec:c}of s.arrayToArray)n=await r("encode",o,
()=>c.encode(n));let i=await r("encode",s.arrayToBytes.name,()=>s.arrayToBytes.codec.encode(n));for(let{name:o,codec:c}of s.
bytesToBytes)i=await r("encode",o,()=>c.encode(i));return i},async decode(n){let s=await t();for(let o=s.bytesToBytes.length-
1;o>=0;o--){let{name:c,codec:l}=s.bytesToBytes[o];n=await r("decode",c,()=>l.decode(n))}let i=await r("decode",s.arrayToBytes.
name,()=>s.arrayToBytes.codec.decode(n));for(let o=s.arrayToArray.length-1;o>=0;o--){let{name:c,codec:l}=s.arrayToArray[o];
i=await r("decode",c,()=>l.decode(i))}return i},async computeEncodedSize(n){let s=await t(),i=sa(s.arrayToBytes.name,s.arrayToBytes.
codec,n);for(let{name:o,codec:c}of s.bytesToBytes)i=sa(o,c,i);return i}}}function sa(a,e,t){if(!e.computeEncodedSize)throw new B(
`Codec "${a}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pipel\
ine`);return e.computeEncodedSize(t)}async function Xo(a){let e=a.codecs.map(async i=>{let o=await Ke.get(i.name)?.();if(!o)
throw new He(i.name);return{Codec:o,meta:i}}),t=[],r,n=[],s={...a};for await(let{Codec:i,meta:o}of e){let c=i.fromConfig(
o.configuration,s);switch(c.kind){case"array_to_array":t.push({name:o.name,codec:c}),c.getEncodedMeta&&(s=c.getEncodedMeta(
s));break;case"array_to_bytes":r={name:o.name,codec:c};break;default:n.push({name:o.name,codec:c})}}if(!r){if(!qo(s))throw new B(
`Cannot encode ${s.dataType} to bytes without a codec`);r={name:"bytes",codec:Ye.fromConfig({endian:"little"},s)}}return{
arrayToArray:t,arrayToBytes:r,bytesToBytes:n}}function qo(a){return a.dataType!=="v2:object"&&a.dataType!=="string"}var aa=18446744073709551615n;function ia(a,e,t,r){if(!a.store.getRange)throw new ye("sharding requires a store with getR\
ange");let n=a.store.getRange.bind(a.store),s=e.map((l,h)=>l/r.chunk_shape[h]),i=Je({dataType:"uint64",shape:[...s,2],codecs:r.
index_codecs,fillValue:null}),o=16*s.reduce((l,h)=>l*h,1),c={};return async(l,h)=>{let m=l.map((x,w)=>Math.floor(x/s[w])),
u=a.resolve(t(m)).path;u in c||(c[u]=(async()=>{let x=await i.computeEncodedSize(o),w=await n(u,{suffixLength:x},h);return w?
await i.decode(w):null})().catch(x=>{throw delete c[u],x}));let p=await c[u];if(p===null)return;let{data:f,shape:d,stride:g}=p,
b=l.map((x,w)=>x%d[w]).reduce((x,w,M)=>x+w*g[M],0),y=f[b],v=f[b+1];if(!(y===aa&&v===aa))return n(u,{offset:Number(y),length:Number(
v)},h)}}var ne=class a{store;path;constructor(e,t="/"){this.store=e,this.path=t}resolve(e){let t=new URL(`file://${this.path.endsWith(
"/")?this.path:`${this.path}/`}`);return new a(this.store,decodeURIComponent(new URL(e,t).pathname))}};function er(a){return new ne(
a??new Map)}var ve=class extends ne{kind="group";#e;constructor(e,t,r){super(e,t),this.#e=r}get attrs(){return this.#e.attributes}};
function oa(a){return a.find(t=>t.name==="transpose")?.configuration?.order??"C"}function Ko(a,e){let t=new Map(e.map((r,n)=>[
r,n]));return a.filter(r=>t.has(r)).map(r=>t.get(r))}function ca(a){return(e,t)=>{let r=globalThis.Array.isArray(a)&&t?Ko(
a,t):a;return zt(e,r)}}var Qt=Symbol("zarrita.context");function Jo(a,e){let{configuration:t}=e.codecs.find(Qs)??{},r={encodeChunkKey:Ks(e.chunk_key_encoding),TypedArray:Ht(e.data_type),
fillValue:e.fill_value};if(t){let s=oa(t.codecs);return{...r,kind:"sharded",chunkShape:t.chunk_shape,codec:Je({dataType:e.
data_type,shape:t.chunk_shape,codecs:t.codecs,fillValue:e.fill_value}),getStrides:ca(s),getChunkBytes:ia(a,e.chunk_grid.
configuration.chunk_shape,r.encodeChunkKey,t)}}let n=oa(e.codecs);return{...r,kind:"regular",chunkShape:e.chunk_grid.configuration.
chunk_shape,codec:Je({dataType:e.data_type,shape:e.chunk_grid.configuration.chunk_shape,codecs:e.codecs,fillValue:e.fill_value}),
getStrides:ca(n),async getChunkBytes(s,i){let o=r.encodeChunkKey(s),c=a.resolve(o).path;return a.store.get(c,i)}}}var le=class extends ne{kind="\
array";#e;[Qt];constructor(e,t,r){super(e,t),this.#e={...r,fill_value:Gt(r)},this[Qt]=Jo(this,this.#e)}get attrs(){return this.#e.
attributes}get dimensionNames(){return this.#e.dimension_names}get fillValue(){return this.#e.fill_value}get shape(){return this.#e.
shape}get chunks(){return this[Qt].chunkShape}get dtype(){return this.#e.data_type}async getChunk(e,t,r){r?.useSharedArrayBuffer&&
Xs();let n=this[Qt],s=await n.getChunkBytes(e,t);if(!s){let i=n.chunkShape.reduce((c,l)=>c*l,1),o;if(r?.useSharedArrayBuffer){
let c=new n.TypedArray(0);if(!("BYTES_PER_ELEMENT"in c))console.warn("zarrita: useSharedArrayBuffer is not supported for\
 non-buffer-backed data types."),o=new n.TypedArray(i);else{let l=qs(i*c.BYTES_PER_ELEMENT,!0);o=new n.TypedArray(l,0,i)}}else
o=new n.TypedArray(i);return o.fill(n.fillValue),{data:o,shape:n.chunkShape,stride:n.getStrides(n.chunkShape)}}return n.
codec.decode(s)}is(e){return Bt(this.dtype,e)}};function la(a,e){let t=a;for(let r of e)t instanceof Promise?t=t.then(n=>r(n)):t=r(t);return t}function ha(a,...e){return la(a,e)}async function pa(a){let e=a.store.arrayExtensions;return e?.length?await ha(a,...e):a}var tr=Zo();function Zo(){let a=new WeakMap;
function e(t){let r=a.get(t)??{v2:0,v3:0};return a.set(t,r),r}return{increment(t,r){e(t)[r]+=1},versionMax(t){let r=e(t);
return r.v3>r.v2?"v3":"v2"}}}async function Qo(a,e){let t=await a.store.get(a.resolve(".zattrs").path,{signal:e});return t?
je(t):{}}async function ec(a,e={}){let t="store"in a?a:new ne(a),{signal:r}=e,n={};return(e.attrs??!0)&&(n=await Qo(t,r)),
r?.throwIfAborted(),e.kind==="array"?ma(t,n,r):e.kind==="group"?ua(t,n,r):ma(t,n,r).catch(s=>(Or(s,q,B),ua(t,n,r)))}async function ma(a,e,t){
let{path:r}=a.resolve(".zarray"),n=await a.store.get(r,{signal:t});if(!n)throw new q("v2 array",{path:r});return tr.increment(
a.store,"v2"),pa(new le(a.store,a.path,Js(je(n),e)))}async function ua(a,e,t){let{path:r}=a.resolve(".zgroup"),n=await a.
store.get(r,{signal:t});if(!n)throw new q("v2 group",{path:r});return tr.increment(a.store,"v2"),new ve(a.store,a.path,Zs(
je(n),e))}async function tc(a,e){let{store:t,path:r}=a.resolve("zarr.json"),n=await a.store.get(r,{signal:e});if(!n)throw new q(
"v3 array or group",{path:r});let s=je(n);return s.node_type==="array"&&(s.fill_value=Gt(s)),s.node_type==="array"?pa(new le(
t,a.path,s)):new ve(t,a.path,s)}async function rc(a,e={}){let t="store"in a?a:new ne(a),r=await tc(t,e.signal);if(tr.increment(
t.store,"v3"),e.kind===void 0||e.kind==="array"&&r instanceof le||e.kind==="group"&&r instanceof ve)return r;let n=r instanceof
le?"array":"group";throw new q(`${e.kind} at ${t.path}`,{path:t.path,found:n})}async function Q(a,e={}){let t="store"in a?
a.store:a,r=tr.versionMax(t),n=r==="v2"?Q.v2:Q.v3,s=r==="v2"?Q.v3:Q.v2;return n(a,e).catch(i=>(Or(i,q,B),s(a,e)))}Q.v2=ec;
Q.v3=rc;var fa=[300,1e3,3e3],da=2e4,sc=[401,403,404,410],ba=200,ac=429,ic=500,oc=2197175160,Fr=4,cc=8,lc=1<<28,$=class extends Error{fault;detail;constructor(e,t,r=t){
super(t),this.fault=e,this.detail=r}},hc=Array.from({length:4},(a,e)=>Uint32Array.from({length:256},(t,r)=>{let n=r;for(let s=0;s<
8*(e+1);s+=1)n=n>>>1^(n&1?oc:0);return n}));function mc(a){let[e,t,r,n]=hc,s=a.length-a.length%4,i=4294967295;for(let o=0;o<
s;o+=4)i^=a[o]|a[o+1]<<8|a[o+2]<<16|a[o+3]<<24,i=n[i&255]^r[i>>>8&255]^t[i>>>16&255]^e[i>>>24];for(let o=s;o<a.length;o+=
1)i=i>>>8^e[(i^a[o])&255];return~i>>>0}async function ya(a,e){let t=[],r=0,n=a?.getReader();try{for(;;){let{done:i=!0,value:o}=await n?.
read()??{};if(i||!o)break;t.push(o),r+=o.length,e(r)}}catch(i){throw n?.cancel().catch(()=>{}),i}let s=new Uint8Array(r);
return t.reduce((i,o)=>(s.set(o,i),i+o.length),0),s}var Nr=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode(){
throw new Error("nothing is written")}decode(e){let t=e.byteLength-Fr;if(t<0)throw new Error("the checksum is missing");
let{buffer:r,byteOffset:n}=e,s=new DataView(r,n+t,Fr).getUint32(0,!0),i=new Uint8Array(r,n,t);if(s!==mc(i))throw new Error(
"checksum mismatch");return i}computeEncodedSize(e){return e+Fr}},Ir=class a{kind="bytes_to_bytes";most;constructor(e){this.
most=e}static fromConfig(e,{shape:t}){return new a(Math.min(t.reduce((r,n)=>r*n,cc),lc))}encode(){throw new Error("nothi\
ng is written")}async decode(e){let t=new Blob([e]).stream();return ya(t.pipeThrough(new DecompressionStream("gzip")),r=>{
if(r>this.most)throw new Error(`a chunk unpacks to more than ${this.most} bytes`)})}};Ke.set("gzip",()=>Promise.resolve(
Ir));Ke.set("crc32c",()=>Promise.resolve(Nr));function uc(a,e){return new Promise((t,r)=>{let n=()=>{clearTimeout(s),r(e.
reason)},s=setTimeout(()=>{e.removeEventListener("abort",n),t()},a);e.addEventListener("abort",n,{once:!0})})}async function pc(a,e){
let t=new AbortController,r=()=>t.abort();e.addEventListener("abort",r,{once:!0});let n=setTimeout(r,da);try{e.throwIfAborted();
let{status:s,body:i}=await fetch(a,{signal:t.signal}),o=await ya(s===ba?i:null,()=>{clearTimeout(n),n=setTimeout(r,da)});
return[s,o]}finally{t.abort(),clearTimeout(n),e.removeEventListener("abort",r)}}async function ga(a,e){for(let t=0;;t+=1){
let r="no server answers";try{let[n,s]=await pc(a,e);if(n===ba)return s;if(sc.includes(n))return;if(r=`the server answer\
s ${n}`,n<ic&&n!==ac)throw new $("broken",r)}catch(n){if(e.throwIfAborted(),n instanceof $)throw n}if(t===fa.length)throw new $(
"unreachable",r);await uc(fa[t],e)}}var rr=class{url;described;shards=new Map;constructor(e,t){this.url=e,this.described=
t}get=async(e,t)=>e.endsWith("/zarr.json")?this.description(e):this.object(e,t?.signal);getRange=async(e,t,r)=>{let n=this.
shards.get(e)??this.object(e,r?.signal);this.shards.set(e,n);let s=await n;return"suffixLength"in t?s?.subarray(-t.suffixLength):
s?.subarray(t.offset,t.offset+t.length)};async object(e,t=new AbortController().signal){let r=await ga(this.url+e,t);if(!r)
throw new $("missing",`${e} is missing`);return r}description(e){let t=this.described.get(e);if(t)return t;let r=ga(this.
url+e,new AbortController().signal);return this.described.set(e,r),r.catch(()=>this.described.delete(e)),r}};function va(a){
if(a instanceof $)return a;let e=a instanceof q&&!a.found?"missing":"broken";return new $(e,a instanceof Error?a.message:
String(a))}var nr=class{url;described=new Map;constructor(e){this.url=e.replace(/\/+$/,"")}async attributes(){let e=new rr(
this.url,this.described);return(await Q.v3(er(e),{kind:"group"})).attrs}async array(e){let t=new rr(this.url,this.described),
r=await Q.v3(er(t).resolve(e),{kind:"array"});if(!r.is("number"))throw new $("broken",`${e} has no numbers`);return r}};var fc=64,dc=32,sr=4096,gc=2**28,bc=["padded","unit","open","nearest","normal","rays"],yc={missing:"it is not in the sto\
re, or the store is not public.",broken:"its data in the store are corrupt.",unreachable:"the store does not answer. The\
 server or the network may be down, or the server does not allow this page to read it (CORS)."},vc=["format","fingerprin\
t","parameter","lines"],xe=(a,e)=>Number.isInteger(a)&&Number(a)>0&&Number(a)<=e,j=(a,e)=>Array.isArray(a)&&a.every(Number.
isFinite)&&(e??a.length)===a.length,xc=(a,e)=>j(a,e)&&a.every(Number.isInteger);function wc({nodes:a,longest:e=0,poles:t=[]}){
return Number.isFinite(e)&&t.length<=2&&t.every(({component:r,line:n,inward:s,near:i,plane:o})=>[0,1].includes(r)&&r===t[0].
component&&n===(s>0?0:a[1-r]-1)&&[1,-1].includes(s)&&xe(i,sr)&&j(o,6))}function Mc(a,{geometry:e,slices:t}){let{geometry:r,
slices:n}=a,{shape:s,rows:i,columns:o}=r,{trace:c}=n;if(!(j(s,2)&&s.every(h=>xe(h,sr)&&h>1)&&[i,o].every(({before:h,size:m},u)=>Number.
isInteger(h)&&xe(m,sr)&&h>=0&&h+s[u]<=m)&&Number.isInteger(r.levels)&&r.levels>=0&&2**r.levels<=Math.max(i.size,o.size)&&
r.triangles===e.triangles&&r.planar===e.planar&&Number.isFinite(r.extent)&&j(r.periodic.map(Number),2)&&j(r.center,3)&&j(
r.frame,9)&&xe(n.count,fc)&&[2,4].includes(n.channels)&&j(n.lags)&&xe(n.lags.length,dc)&&n.sides===t.sides&&j(n.extra)&&
n.extra.every(h=>Number.isInteger(h)&&h>=0&&h<n.count)&&j([n.unit,n.cell,n.critical])&&(!c||c.parts.every(h=>bc.includes(
h))&&j(c.nodes,2)&&c.nodes.every((h,m)=>xe(h,sr)&&c.drawn[m]+s[m]<=h)&&xc([...c.first,...c.drawn],4)&&c.drawn.every(h=>h>=
0)&&j(c.closed.map(Number),2)&&j([...c.offset,...c.middle,c.unit,c.pace,c.rest],12)&&wc(c)&&(!c.timed||j([c.timed.unit,c.
timed.speed],2)))))throw new Error("the header of a tile does not match the page")}function wa({geometry:a,slices:e}){let{
shape:t,planar:r}=a,{trace:n,count:s,channels:i,extra:o}=e,c=(p,...f)=>[...p,...f].reduce((d,g)=>d*g,1),l=[a.rows.size,a.
columns.size],h=n?.nodes??[],m={cells:[Uint8Array,[c(t.map(p=>p-1))]],normal:[Int16Array,[c(t,3)]],scalars:[Float32Array,
[c(t)]]};if(n){m.unit=[Uint16Array,[c(h)]],m.padded=[Float32Array,[c(h.map(f=>f+2),3)]],m.open=[Uint8Array,[c(h)]],m.nearest=
[Int16Array,[c(h,2)]];let p=n.poles??[];m.rays=[Float32Array,[c(p.slice(0,1).map(f=>h[f.component]),2,p.length)]],m.flow=
[Uint16Array,n.uncertain?[c(h,5)]:[c(h,3),c(h,4)]]}else m.position=[Float32Array,[c(t,3)]],m.slices=[Uint16Array,[c(l,s,
i)]],m.extra=[Uint16Array,[c(l,o.length)]];let u=n?["mesh",...n.parts]:["mesh","position",...r?[]:["normal"]];return{sizes:m,
needed:u}}function Cr(a,e,t){let{sizes:r}=wa(e),n=e.geometry.shape.map(s=>Math.ceil((s-1)/t));for(let{name:s,data:i,shape:o}of a){
let c=r[s.split("/")[0]];if(!(c?i instanceof c[0]&&c[1].includes(i.length):s==="mesh"&&i instanceof Float32Array&&o.length===
3&&o[0]===n[0]&&o[1]===n[1]&&i.length===o[0]*o[1]*o[2]))throw new Error(`the part "${s}" of a tile has a wrong size`)}}function Ec(a,{
geometry:e,slices:t},r){let[n,s]=e.shape,[i,{drawn:o,nodes:c}={drawn:[0,0],nodes:[0,0]}]=[a.shape[2],t.trace],l=new Float32Array(
n*s);for(let h=0;h<l.length;h+=1){let m=(Math.floor(h/s)+o[0])*c[1]+h%s+o[1];l[h]=r*Le[Number(a.data[i*(m+1)-1-Number(t.
trace?.uncertain??!1)])]}return{name:"",data:l,shape:[n,s],digest:`${a.digest} speed`}}function xa(a){let e=va(a);return e.
fault==="other"||e.detail!==e.message?e:new $(e.fault,yc[e.fault],e.message)}var ar=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(e,t){
let r=e.store;if(!r)throw new Error("the page does not say where its store is");this.header=e,this.told=r,this.url=new URL(
r.url,t),this.store=new nr(this.url.href)}open(){return this.opening??=this.compare().catch(e=>{let t=xa(e);throw t.fault===
"unreachable"&&(this.opening=null),t}),this.opening}async compare(){let{url:e}=this.told;if(!/^https?:/.test(this.url.protocol)){
let n=`This page reads its store from ${e} in the same folder, which browsers do not allow when the page is opened as a \
file: open it from a web server.`;throw new $("other",n)}let t=(await this.store.attributes()).flowtex;if(vc.every(n=>t?.[n]===
this.told[n]))return;let r=`The store at ${e} does not match this page: it has another flow, other paths or another vers\
ion: export the page again.`;throw new $("other",r)}load=async(e,t,r,n)=>{let s=e??[this.told.depth,0,0],i=G(s);return this.
loaded(r,async o=>{let c=t.filter(d=>!n(`slices/${d}`)&&!n(`flow/${d}`)),l=e?n("header")&&!c.length?this.headers.get(i):
void 0:this.header,h=l===void 0?this.surface(s,o):{header:l,parts:[]},m=new Map(c.map(d=>[d,this.flow(s,d,o)])),u=[...m.
values()],p=async()=>{let{header:d,parts:g}=await h;if(e&&this.headers.set(i,d),!d)return g;let[b,...y]=await Promise.all(
[this.values(s,d,t,n,o,m),...u]);if(Cr(y.flat(),d,this.header.mesh.tileCells),!y.every(v=>v.length))throw new Error(`til\
e ${i} has no flow`);return[...g,...y.flat(),...b]},[f]=await Promise.all([p(),...u]);return e?f.map(d=>({...d,name:`til\
e/${i}/${d.name}`})):f})};async loaded(e,t){let r=new AbortController;e.addEventListener("abort",()=>r.abort(),{once:!0});
try{return await this.open(),e.throwIfAborted(),await t(r.signal)}catch(n){throw e.throwIfAborted(),xa(n)}finally{r.abort()}}async file(e,t,r,n){
let s=await this.store.array(`${t[0]}/${e}`),i=async f=>{let{data:d}=await s.getChunk([...r,f],{signal:n});if(!(d instanceof
Uint8Array))throw new Error(`${s.path} is empty`);return d},o=await i(0),[c,l]=hr(o),h=c.reduce((f,{bytes:d})=>f+d,l);if(!xe(
h,gc))throw new Error(`a file of ${s.path} has a wrong size`);let m=new Uint8Array(Math.ceil(h/o.length)*o.length);m.set(
o);for(let f=1;f*o.length<h;f+=1)m.set(await i(f),f*o.length);let u=new Map;for(let f of Xr(m.buffer)){let[d,g]=ue(f.name)??
["",f.name];if(d&&d!==G(t))throw new Error(`in place of tile ${G(t)} is ${d}`);u.set(g,{...f,name:g})}if(new TextDecoder().
decode(u.get("of")?.data)!==this.told.fingerprint)throw new Error(`tile ${G(t)} belongs to another flow`);return u.delete(
"of"),u}async surface(e,t){let r=await this.file("surface",e,[e[1],e[2]],t),n=this.tileHeader(r.get("header"));if(r.delete(
"header"),n){let o=wa(n).needed.filter(c=>!r.has(c));if(o.length)throw new Error(`a tile has no ${o.join(", ")}`);Cr([...r.
values()],n,this.header.mesh.tileCells)}let s=new TextEncoder().encode(JSON.stringify(n)),i={name:"header",data:s,shape:[
s.length],digest:`${this.told.fingerprint} ${G(e)} header`};return{header:n,parts:[i,...r.values()]}}tileHeader(e){let t=JSON.
parse(new TextDecoder().decode(e?.data));if(t===null)return null;let{steps:r,times:n,timeUnit:s,dates:i,pace:o}=this.header.
slices;return Mc(t,this.header),{...t,slices:{...t.slices,steps:r,times:n,timeUnit:s,dates:i,pace:o}}}async flow(e,t,r){
let n=this.told.steps[t];return[...(await this.file("flow",e,[n,e[1],e[2]],r)).values()].map(i=>{let[o,c]=i.name.split("\
/");if(Number(c)!==n)throw new Error(`in place of step ${n} is ${i.name}`);return{...i,name:`${o}/${t}`}})}async values(e,t,r,n,s,i){
let o=new Map;for(;;){let{name:c,steps:l,number:h}=this.header.scalars,u=(l>1?r:[0]).map(d=>h?`scalars/${d}/${h}`:`scala\
rs/${d}`),p=c===null?[]:u.filter(d=>!n(d)&&!o.has(d));if(!p.length)return[...o.values()];let f=await Promise.all(p.map(async d=>{
let g=l>1?X(d):0;if(!h&&this.told.derivesSpeed&&t.slices.trace){let[x]=await(i.get(g)??this.flow(e,g,s));return{...Ec(x,
t,this.header.speed.typical),name:d}}let b=l>1?this.told.steps[g]:0,v=(await this.file("values",e,[b,e[1],e[2],h],s)).get(
`scalars/${b}/${h}`);if(!v)throw new Error(`tile ${G(e)} has no values of step ${b}`);return{...v,name:d}}));Cr(f,t,this.
header.mesh.tileCells);for(let d of f)o.set(d.name,d)}}};var Sc=4096,Ac=4,Ma=32,Tc=.25,_c=1e4,Ea=class{id;type="custom";renderingMode="2d";options;map=null;gl=null;programs=null;array=null;scene=null;pictures=[];look="";globe=!1;shownOpacity=1;close=null;asked=Promise.
resolve(null);own;colours={};constructor(e){this.options=e,this.own={...e.settings},this.id=e.id}onAdd(e,t){this.onRemove(),
this.map=e,this.gl=t;let r={context:t,counted:n=>n,free:()=>{}};this.programs=new Se(r),this.array=t.createVertexArray(),
this.open(t).catch(n=>this.failed(n.message,""))}onRemove(){let{gl:e}=this;for(let t of this.pictures)t.dispose(e);this.
close?.then(t=>t.dispose()),this.close=null,e?.deleteVertexArray(this.array),this.programs?.dispose(),this.map=this.gl=this.
scene=null,[this.pictures,this.look]=[[],""]}async open(e){let{scene:t,opacity:r}=this.options,n=new URL(typeof t=="stri\
ng"?t:"",location.href).href,{headers:s,parts:i}=typeof t=="string"?await Pc(n):t;if(this.gl!==e)return;let o=Rc(s[0]),c=new Dt(
o,i.flatMap(([f,d,g])=>f?[]:[[d,g]]),new Map,new Map),l=o.store?new ar(o,n):c,h={header:o,settings:{...o.settings,...o.own,
...this.own},player:new mt};this.shownOpacity=r??s[0].opacity;let m=async(f,d)=>{let g=!0,b=new Ct(f,{...h,source:l,isComing:()=>g});
d(b);for(let y of c.parts){let v=await c.kept(y);if(b.lifetime.isOver)break;b.setPart(v)}return g=!1,Object.keys(this.colours).
length&&b.chooseColours(this.colours),b},u=()=>{let f=null;return m(this.hostOf(()=>f),d=>this.pictures.push(f=new Vt(e,
d)))},p=await u();this.gl===e&&(this.scene={...h,add:u,make:m,mercator:new Ut(o.earth,p.parts.get("lonlat"))},p.requests.
open(),this.options.onOpen?.(),this.map?.triggerRepaint())}hostOf=e=>({isHeld:()=>this.map?.isMoving()??!1,painted:t=>{e()?.
painted(t),this.map?.triggerRepaint()},advanced:()=>this.options.onTime?.(this.time),failed:(t,r)=>this.failed(t,r)});get time(){
let{varies:e=!1,time:t=0,clock:r=0}=this.scene?.player??{};return e?t:r}set time(e){let{player:t}=this.scene??{};t?.varies?
t.seek(e):t&&(t.clock=e),this.change()}get times(){return this.scene?.header.slices.times??[]}get bounds(){let{mercator:e}=this.
scene??{};if(!e)return null;let{box:t}=e;return[e.lngLatOf(t.slice(0,2)),e.lngLatOf(t.slice(2))]}get opacity(){return this.
shownOpacity}set opacity(e){this.shownOpacity=e,this.map?.triggerRepaint()}play(){let{player:e,settings:t}=this.scene??{};
!e||!t||(!e.varies&&t.motion==="off"&&(t.motion="speed"),e.start(),this.change())}pause(){this.scene&&(this.scene.player.
playing=!1),this.change()}set(e){Object.assign(this.own,e),Object.assign(this.scene?.settings??{},e),this.change()}setColours(e){
Object.assign(this.colours,e);for(let{view:t}of this.pictures)t.chooseColours(e)}change(){for(let{view:e}of this.pictures)
e.change()}async pointAt(e){let{mercator:t,header:r}=this.scene??{};if(!t||!r)return null;let n=[...t.positionOf(ge(e)),
r.geometry.center[2]],s=this.pictures.filter(({isUsed:c})=>c).map(({view:c})=>c);await Aa(()=>s.every(({painter:c})=>c.canPick&&
c.shown));let i=s.map(c=>this.pointIn(c,n)).find(Boolean)??null;if(i&&!r.pyramid)return i;this.asked=this.asked.then(()=>this.
pointClose(n)).catch(()=>null);let o=await this.asked;return o&&{...o,path:i?.path??o.path}}pointIn(e,t){let{camera:r,parts:n,
settings:s}=e,{mercator:i}=this.scene??{},o=r?.project(t)??[2,2],c=Math.max(...o.map(Math.abs))>1?null:e.find(o[0],o[1]),
l=e.painter.shown;if(!i||!r||!c||!l)return null;let h=c.point.position,m={scene:c.layer.scene,moment:l,place:c.place,position:h},
[u,p]=ls(m,n.get("lonlat"))??[NaN,NaN],{path:f}=ss(m,s,r,e.rows);return{eastward:u,northward:p,values:c.point.values,path:f.
map(d=>i.lngLatOf(d))}}async pointClose(e){let{scene:t}=this;if(!t)return null;let r=!1,n={...this.hostOf(()=>null),painted:()=>{
r=!0},advanced:()=>{}},s=await(this.close??=t.make(n,f=>f.requests.open())),{box:i}=t.mercator,{pyramid:o,geometry:c}=t.
header,l=Tc*(i[2]-i[0])/(o?.shapes[0]??c.shape)[1],[h,m,u]=e,p={up:[0,1,0],view_angle:30,position:[h,m,u+l],focal_point:e,
parallel:!0,parallel_scale:l};return s.isVisible=!0,s.look(p,Ma,Ma,1),await Aa(()=>r&&s.painter.canPick&&!s.tiles?.pending&&
!s.tiles?.missing.length),s.isVisible=!1,this.pointIn(s,e)}failed(e,t){this.map?.fire("error",{error:new Error([e,t].filter(
Boolean).join(" "))})}render(e,t){let{map:r,scene:n,programs:s,array:i,opacity:o}=this;if(!r||!n||!s)return;let c=t.defaultProjectionData.
projectionTransition>0;this.follow(r,n,c);let[l,h]=[r.getZoom(),r.getCenter()],m=this.pictures.filter(({isUsed:d})=>d),{
shaderData:u,getProjectionData:p}=t,f={gl:e,programs:s,array:i,shaderData:u,getProjectionData:p,zoom:l,center:h,globe:c,
opacity:o};for(let d of m){let g=d.draw({...f,mercator:n.mercator,isRepeated:m.length===1});typeof g=="string"&&g?this.failed(
"The flow cannot be drawn on the map.",g):g!==!0&&r.triggerRepaint()}}follow(e,{mercator:t,header:r,add:n},s){let{what:i,
ratio:o,text:c}=Sa(e,s);if(c===this.look)return;let l=t.look(i,r.geometry.center[2]);l.length>this.pictures.length&&n(),
[0,1].forEach(h=>{let{width:m=1,height:u=1}=l[h]??{},p=Math.sqrt(Ac*i.width*i.height/(m*u));this.pictures[h]?.follow(l[h],
Math.min(o,o*p,Sc/Math.max(m,u)))}),this.look=c,this.globe=s}get isComplete(){let{map:e,pictures:t}=this;return!e||!this.
scene||!t.every(r=>r.isComplete)?!1:this.look===Sa(e,this.globe).text}};function Sa(a,e){let{clientWidth:t,clientHeight:r}=a.
getCanvas(),n={center:a.unproject([t/2,r/2]),width:t,height:r,zoom:a.getZoom(),bearing:a.getBearing(),pitch:a.getPitch(),
fov:a.getVerticalFieldOfView(),globe:e},s=a.getPixelRatio();return{what:n,ratio:s,text:JSON.stringify([n,s])}}async function Aa(a){
let e=performance.now()+_c;for(;!a()&&performance.now()<e;)await new Promise(requestAnimationFrame)}async function Pc(a){
let e=await fetch(a);if(!e.ok)throw new Error(`the scene ${a} cannot be read: the server answers ${e.status}`);return await e.
json()}function Rc(a){let{earth:e}=a;return{...a,background:[0,0,0],opacity:1,earth:e&&{...e,...{land:null,coastlines:!1,
graticule:!1}}}}export{Ea as FlowtexLayer};
